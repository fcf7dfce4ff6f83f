// The pulse ends after 10,000 microsecond strobes at the latest (and the requested ones), so within
// 340,000 clocks; 100,000 strobes pass before the next one; the charger is off from before the
// pulse until 20,000 strobes after it; nothing fires or charges while disabled.
// All charging since the capacitor was full, a pulse or a disarming together is at most the time-out and the
// strobe in which it ends, however often it is asked for. The ball fires only for an `arm_on_ball` that rose
// while enabled and has not fired yet.
// Assumed: at most 34 clocks between strobes (proven in timebase.v); the lock-out and the time-out
// change only while disabled (registers.v).
localparam FORMAL_PULSE = 10000, FORMAL_LOCKOUT = 100000, FORMAL_COMMUTATION = 20000;
reg formal_running = 0, formal_trigger = 0, formal_enable = 0;
reg [5:0] formal_gap = 0;       // clocks since the last strobe
reg [14:0] formal_strobes = 0;  // strobes in this pulse
reg [19:0] formal_clocks = 0;   // clocks of this pulse before this one
reg [17:0] formal_rest = FORMAL_LOCKOUT;  // strobes since the last pulse, saturated at the lock-out
reg [24:0] formal_charged = 0;  // strobes of charging since full, a pulse, or disabled
reg [23:0] formal_timeout = 0;
reg formal_asked = 0;           // arm_on_ball a clock ago
reg formal_shot = 0;            // it rose while enabled, and has its shot

always @(posedge clock) begin
    formal_running <= 1;
    formal_timeout <= charge_timeout;
    formal_charged <= !enable || stuffed || trigger ? 25'd0 : formal_charged + (charge && microsecond);
    formal_asked <= arm_on_ball;
    formal_shot <= enable && arm_on_ball && !accepts && (formal_shot || !formal_asked);
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
    if (formal_enable) assume (charge_timeout == formal_timeout);
    assert (formal_charged <= {1'b0, charge_timeout} + 25'd1);
    if (accepts && !fire) assert (arm_on_ball && (formal_shot || !formal_asked));
    assert (on_ball == (arm_on_ball && (formal_shot || !formal_asked)));
    // Invariants that carry the induction.
    assert (formal_asked ? formal_shot == !spent_q : !spent_q && !formal_shot);
    assert (charged_q <= charge_timeout);
    assert (formal_charged == charged_q
        || (formal_charged == charged_q + 25'd1 && charged_q == charge_timeout && !charge));
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
