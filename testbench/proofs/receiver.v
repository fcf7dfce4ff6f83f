// A byte is the eight bits before it, and nothing is heard but between a start bit and its stop bit: bits
// and bytes come only while hearing, one at a time, and hearing begins only when the line is low.
reg formal_hears_before = 0, formal_low_before = 0;
reg [7:0] formal_bits = 0;
reg [3:0] formal_count = 0;
always @(posedge clock) begin
    formal_hears_before <= hearing;
    formal_low_before <= !level;
    if (start) formal_count <= 0;
    else if (data_bit) begin
        formal_bits <= {level, formal_bits[7:1]};
        formal_count <= formal_count + 1;
    end
end
always @(*) begin
    assert (!hearing || formal_hears_before || formal_low_before);
    assert (!(byte_done || broken || data_bit) || hearing);
    assert ({1'b0, byte_done} + broken + data_bit <= 1);
    if (byte_done) assert (formal_count == 8 && value == formal_bits && level);
    if (start) assert (enable && !level && !hearing);
    // Invariants that carry the induction.
    if (hears_q) assert (bits_q <= stop_bit && clocks_q <= whole_bit);
    if (hears_q) assert (formal_count == (bits_q == 0 ? 0 : bits_q - 1));
    assert (formal_bits == shift_q);
end
