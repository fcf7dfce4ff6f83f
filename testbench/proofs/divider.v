// Nothing wraps: the remainder stays below the divisor, the quotient is a word of 30 bits with the
// sign of the numerator, and a quotient that does not fit is clamped, division by zero included.
// Assumed: the numerator's magnitude fits 25 bits.
wire signed [31:0] formal_numerator = numerator;
reg formal_zero = 0;  // the divisor of this division is zero
reg [31:0] formal_bits = 0;  // the quotient's bits, when all of them are there
wire [31:0] formal_clamped = overflow_q || |formal_bits[31:29] ? 32'h1FFFFFFF : formal_bits;
always @(posedge clock) if (steps_q == 2) formal_bits <= bits_q;
always @(posedge clock) if (start && !running) formal_zero <= denominator[23:0] == 0;

always @(*) begin
    if (start) assume (formal_numerator < 33554432 && formal_numerator > -33554432);
    if (!running) begin
        assert ($signed(quotient) <= 32'sh1FFFFFFF && $signed(quotient) >= -32'sh1FFFFFFF);
        if (quotient != 0) assert (quotient[31] == negative_q);
        assert (quotient == (negative_q ? -formal_clamped : formal_clamped));
    end
    // Invariants that carry the induction.
    if (!checking_q && !overflow_q) assert (remainder_q < divisor_q || (divisor_q == 0 && remainder_q == 0));
    assert (steps_q <= 35 && checking_q == (steps_q == 35));
    if (steps_q == 1) assert (bits_q == formal_clamped);
    assert (!divisor_q[24]);
end
