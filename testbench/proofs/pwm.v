// PWM: the bridge never sees DIR change while PWM is high or was high a moment ago.
// Assumed: the blanking time changes only while disabled (proven in registers.v).
// In sign-magnitude mode pulse and reverse are the pins; in up/down mode each pin has the pulses of
// its direction, never both, and what is shown of pulse and reverse holds between them.
wire formal_pulse = pwm_pin_q, formal_reverse = dir_pin_q;
always @(*) begin
    if (!up_down) assert (pwm == formal_pulse && dir == formal_reverse);
    if (up_down) assert (!(pwm && dir) && (pwm || dir) == formal_pulse);
    if (up_down && dir) assert (formal_reverse);
    if (up_down && pwm) assert (!formal_reverse);
end

reg formal_running = 0, formal_pwm, formal_dir, formal_enable, formal_stops = 1;
reg [9:0] formal_blanking;
reg [10:0] formal_low = 0;  // clocks before this one for which pwm was low
reg [10:0] formal_age = 0;  // clocks before this one since dir changed
wire formal_turned = formal_reverse != formal_dir;
wire [10:0] formal_since = formal_turned ? 11'd0 : formal_age;

always @(posedge clock) begin
    formal_running <= 1;
    formal_pwm <= formal_pulse;
    formal_dir <= formal_reverse;
    formal_enable <= enable;
    formal_stops <= stops;
    formal_blanking <= blanking;
    formal_low <= formal_pulse ? 11'd0 : formal_low + !(&formal_low);
    formal_age <= formal_since + !(&formal_since);
end

always @(*) if (formal_running) begin
    assume (!formal_enable || blanking == formal_blanking);
    if (formal_turned) assert (!formal_pulse && formal_low >= blanking);
    if (formal_pulse && !formal_pwm) assert (formal_since >= blanking);
    if (!formal_enable) assert (!formal_pulse && !formal_turned);
    // Invariants that carry the induction.
    assert (quiet_q <= formal_low && quiet_q <= formal_since);
    if (settled_q) assert (formal_since >= blanking);
    if (rested_q) assert (formal_since >= blanking && formal_low >= blanking);
    if (!formal_enable) assert (!settled_q && !rested_q && quiet_q == 0);
end
// After a clock with `stops` there is no pulse at either pin, whatever the mode.
always @(*) if (formal_stops) assert (!pwm && (!up_down || !dir));
always @(*) if (!formal_running) assert (!formal_pulse && !settled_q && !rested_q && quiet_q == 0);
