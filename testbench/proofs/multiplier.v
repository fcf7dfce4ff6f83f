// Nothing wraps: every partial sum of the serial multiplication fits its 32 bits, and the result is
// the wide product clamped to a word. Assumed: the first operand is a word of 30 bits, signed.
localparam signed [40:0] FORMAL_MAX = 41'sh1FFFFFFF;
localparam signed [40:0] FORMAL_MIN = -41'sh20000000;
wire signed [32:0] formal_p = {p_q[31], p_q};
wire signed [32:0] formal_addend = {addend[31], addend};
wire signed [32:0] formal_sum = negate_q ? formal_p - formal_addend : formal_p + formal_addend;
wire signed [40:0] formal_wide = guard_8_q ? {p_q[31], p_q, lo_q[31:24]} : {{7{p_q[31]}}, p_q, lo_q[31:30]};
wire formal_word_a = a[31:29] == 3'b000 || a[31:29] == 3'b111;

always @(*) begin
    if (start) assume (formal_word_a);
    if (running) assert (formal_sum == $signed(sum));
    assert ($signed(result)
        == (formal_wide > FORMAL_MAX ? FORMAL_MAX : formal_wide < FORMAL_MIN ? FORMAL_MIN : formal_wide));
    // Invariants that carry the induction.
    assert (running == (steps_q != 0));
    assert (operand_q[31:29] == 3'b000 || operand_q[31:29] == 3'b111);
    assert (p_q[31:30] == 2'b00 || p_q[31:30] == 2'b11);
end
