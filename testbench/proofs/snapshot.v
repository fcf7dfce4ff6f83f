// From the read of word 0 to the read of the last word the bus reads one finished bank, which the
// program does not write. Assumed: ticks and ends of the program alternate.
reg formal_busy = 0;      // the program runs
reg formal_reading = 0;   // word 0 has been read, the last word not yet
reg formal_bank = 0;      // the bank that word 0 was read from
reg [1:0] formal_whole = 2'b11;  // bank holds a finished tick, or the zeros of power-up
wire formal_reads = formal_reading || read_first;

always @(posedge clock) begin
    if (tick) formal_busy <= 1;
    if (done) formal_busy <= 0;
    if (read_first) formal_bank <= read_bank;
    formal_reading <= (formal_reading || read_first) && !read_last;
    if (formal_busy) formal_whole[write_bank] <= done;
end

always @(*) begin
    assume (!(tick && formal_busy) && !(done && !formal_busy) && !(read_first && read_last));
    if (formal_reading && !read_first) assert (read_bank == formal_bank);
    if (formal_reads) assert (formal_whole[read_bank] && !(formal_busy && write_bank == read_bank));
    // Invariants that carry the induction.
    assert (held_q == formal_reading && (!held_q || held_bank_q == formal_bank));
    assert (formal_whole[latest_q] && !(formal_busy && writing_q == latest_q));
    assert (formal_busy || (&formal_whole));
end
