// Nothing wraps: the remainder stays below the divisor, and the quotient is a word of 30 bits with the sign of
// the numerator, all its bits inverted where that is negative; one that does not fit is the largest word,
// division by zero included.
reg [32:0] formal_bits = 0;   // the quotient's bits so far, with those that do not fit
reg [5:0] formal_taken = 0;   // how many
wire [28:0] formal_word = |formal_bits[32:29] ? 29'h1FFFFFFF : formal_bits[28:0];
always @(posedge clock) begin
    if (running) begin
        formal_bits <= {formal_bits[31:0], goes};
        formal_taken <= formal_taken + 6'd1;
    end else if (start) begin
        formal_bits <= 0;
        formal_taken <= 0;
    end
end
// The bits of the word so far, as they should stand.
wire [5:0] formal_of_word = formal_taken < 4 ? 6'd0 : formal_taken - 6'd4;
wire [28:0] formal_mask = ~(29'h1FFFFFFF << formal_of_word);
wire [28:0] formal_shown = (negative_q ? ~bits_q : bits_q) ^ (overflow_q ? 29'h1FFFFFFF : formal_bits[28:0]);
reg formal_begun = 0;
always @(posedge clock) if (start) formal_begun <= 1;

always @(*) begin
    if (formal_begun && !running) begin
        assert ($signed(quotient) <= 32'sh1FFFFFFF && $signed(quotient) >= -32'sh20000000);
        assert (quotient[31] == negative_q);
        assert (quotient == (negative_q ? ~{3'd0, formal_word} : {3'd0, formal_word}));
    end
    // Invariants that carry the induction.
    assert (running == (steps_q != 0));
    assert (steps_q <= 33 && (formal_begun || steps_q == 0));
    if (formal_begun) begin
        assert (formal_taken == 33 - steps_q);
        assert (overflow_q == |(formal_bits >> formal_of_word));
        assert ((formal_shown & formal_mask) == 0);
        assert (formal_bits >> formal_taken == 0);
        if (!overflow_q) assert (remainder_q < divisor_q || (divisor_q == 0 && remainder_q == 0) || formal_taken == 0);
    end
end
