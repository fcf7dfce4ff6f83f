// The filter of the emergency stop: 18 clocks after the inverted pin went low, its value is low.
localparam FORMAL_LIMIT = 15;
reg [4:0] formal_low = 0;  // clock edges in a row that saw the pin low
always @(posedge clock) formal_low <= pin ? 5'd0 : formal_low + !(&formal_low);

always @(*) begin
    if (formal_low >= FORMAL_LIMIT + 3) assert (!value);
    // Invariants that carry the induction.
    assert (limit == FORMAL_LIMIT && run_q <= FORMAL_LIMIT);
    if (formal_low >= 1) assert (!first_q);
    if (formal_low >= 2) assert (!second_q);
    if (formal_low >= 2 && value) assert (formal_low <= run_q + 6'd2);
end
