// Word 0 is of the tick that finished last, and from it to the last word the bus reads one finished bank, which
// the program does not write. Assumed: ticks and ends of the program alternate.
reg formal_busy = 0;      // the program runs
reg formal_reading = 0;   // word 0 has been read, the last word not yet
reg [1:0] formal_bank = 0;      // the bank that word 0 was read from
reg [1:0] formal_finished = 0;  // the bank of the tick that finished last, or the zeros of power-up
reg [3:0] formal_whole = 4'b0111;  // bank holds a finished tick, or the zeros of power-up
wire formal_reads = formal_reading || read_first;

always @(posedge clock) begin
    if (tick) formal_busy <= 1;
    if (done) formal_busy <= 0;
    if (done) formal_finished <= write_bank;
    if (read_first) formal_bank <= read_bank;
    formal_reading <= (formal_reading || read_first) && !read_last;
    if (formal_busy) formal_whole[write_bank] <= done;
end

always @(*) begin
    assume (!(tick && formal_busy) && !(done && !formal_busy) && !(read_first && read_last));
    if (read_first) assert (read_bank == formal_finished);
    if (formal_reading && !read_first) assert (read_bank == formal_bank);
    if (formal_reads) assert (formal_whole[read_bank] && !(formal_busy && write_bank == read_bank));
    // Invariants that carry the induction.
    assert (held_q == formal_reading && (!held_q || held_bank_q == formal_bank));
    assert (formal_whole[latest_q] && !(formal_busy && writing_q == latest_q) && latest_q == formal_finished);
    assert (writing_q != 3 && latest_q != 3 && held_bank_q != 3);
    assert (formal_busy ? (formal_whole | 4'b0001 << write_bank) == 4'b0111 : formal_whole == 4'b0111);
end
