// PWM, sign-magnitude: the bridge never sees DIR change while PWM is high or was high a moment ago.
// Assumed: the blanking time changes only while disabled (proven in registers.v).
reg formal_running = 0, formal_pwm, formal_dir, formal_enable;
reg [9:0] formal_blanking;
reg [10:0] formal_low = 0;  // clocks before this one for which pwm was low
reg [10:0] formal_age = 0;  // clocks before this one since dir changed
wire formal_turned = dir != formal_dir;
wire [10:0] formal_since = formal_turned ? 11'd0 : formal_age;

always @(posedge clock) begin
    formal_running <= 1;
    formal_pwm <= pwm;
    formal_dir <= dir;
    formal_enable <= enable;
    formal_blanking <= blanking;
    formal_low <= pwm ? 11'd0 : formal_low + !(&formal_low);
    formal_age <= formal_since + !(&formal_since);
end

always @(*) if (formal_running) begin
    assume (!formal_enable || blanking == formal_blanking);
    if (formal_turned) assert (!pwm && formal_low >= blanking);
    if (pwm && !formal_pwm) assert (formal_since >= blanking);
    if (!formal_enable) assert (!pwm && !formal_turned);
    // Invariants that carry the induction.
    assert (quiet_q <= formal_low && quiet_q <= formal_since);
    if (settled_q) assert (formal_since >= blanking);
    if (!formal_enable) assert (!settled_q && quiet_q == 0);
end
always @(*) if (!formal_running) assert (!pwm && !settled_q && quiet_q == 0);
