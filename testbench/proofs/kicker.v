// The pulse ends after 10,000 microsecond strobes at the latest (and the requested ones), so within
// 340,000 clocks; 100,000 strobes pass before the next one; the charger is off from before the
// pulse until 20,000 strobes after it; nothing fires or charges while disabled.
// Assumed: at most 34 clocks between strobes (proven in timebase.v); the lock-out changes only
// while disabled (registers.v).
localparam FORMAL_PULSE = 10000, FORMAL_LOCKOUT = 100000, FORMAL_COMMUTATION = 20000;
reg formal_running = 0, formal_trigger = 0, formal_enable = 0;
reg [5:0] formal_gap = 0;       // clocks since the last strobe
reg [14:0] formal_strobes = 0;  // strobes in this pulse
reg [19:0] formal_clocks = 0;   // clocks of this pulse before this one
reg [17:0] formal_rest = FORMAL_LOCKOUT;  // strobes since the last pulse, saturated at the lock-out

always @(posedge clock) begin
    formal_running <= 1;
    formal_trigger <= trigger;
    formal_enable <= enable;
    formal_gap <= microsecond ? 6'd0 : formal_gap + 6'd1;
    formal_strobes <= trigger ? formal_strobes + microsecond : 15'd0;
    formal_clocks <= trigger ? formal_clocks + 20'd1 : 20'd0;
    if (trigger) formal_rest <= 0;
    else if (microsecond && formal_rest < FORMAL_LOCKOUT) formal_rest <= formal_rest + 18'd1;
end

always @(*) begin
    assume (microsecond || formal_gap < 33);
    if (trigger) assert (formal_strobes < FORMAL_PULSE && formal_clocks < 34 * FORMAL_PULSE);
    if (trigger) assert (!charge);
    if (trigger && !formal_trigger) assert (formal_rest >= FORMAL_LOCKOUT);
    if (charge) assert (formal_rest >= FORMAL_COMMUTATION);
    if (formal_running && !formal_enable) assert (!charge && !trigger);
    // Invariants that carry the induction.
    assert (formal_rest <= FORMAL_LOCKOUT);
    assert (trigger == (now_q == pulse_state) && now_q <= 5);
    if (trigger) assert (coming_q == formal_strobes + 1 && formal_clocks <= 34 * formal_strobes + formal_gap);
    if (!trigger && now_q < 4) assert (formal_rest >= FORMAL_LOCKOUT);
    if (now_q == commutation_state || now_q == lockout_state)
        assert (coming_q != 0 && (coming_q <= FORMAL_LOCKOUT ? formal_rest == coming_q - 1 : formal_rest == FORMAL_LOCKOUT));
    if (now_q == commutation_state) assert (coming_q <= FORMAL_COMMUTATION);
    if (now_q == lockout_state) assert (coming_q > FORMAL_COMMUTATION);
    if (charge) assert (now_q == ready_state || now_q == lockout_state);
end
