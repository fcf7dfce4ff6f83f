// Nothing wraps: the remainder stays below the divisor, the quotient is a word of 30 bits with the
// sign of the numerator, and a quotient that does not fit is clamped, division by zero included.
// Assumed: the numerator's magnitude fits 25 bits.
wire signed [31:0] formal_numerator = numerator;
reg formal_zero = 0;  // the divisor of this division is zero
always @(posedge clock) if (start && !running) formal_zero <= denominator[23:0] == 0;

always @(*) begin
    if (start) assume (formal_numerator < 33554432 && formal_numerator > -33554432);
    assert ($signed(quotient) <= 32'sh1FFFFFFF && $signed(quotient) >= -32'sh1FFFFFFF);
    if (quotient != 0) assert (quotient[31] == negative_q);
    if (!running && !checking_q && (overflow_q || |bits_q[31:29]))
        assert (quotient == (negative_q ? -32'h1FFFFFFF : 32'h1FFFFFFF));
    if (!running && !overflow_q && bits_q[31:29] == 0)
        assert (quotient == (negative_q ? -bits_q : bits_q));
    // Invariants that carry the induction.
    if (!checking_q && !overflow_q) assert (remainder_q < divisor_q || (divisor_q == 0 && remainder_q == 0));
    assert (steps_q <= 33 && checking_q == (steps_q == 33));
    assert (!divisor_q[24]);
end
