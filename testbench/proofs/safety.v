// Outputs are released only by the arm sequence and taken back by every cause, in bounded time.
// The sequence arms whenever no cause stands from its first word to its second, whatever the fault registers
// show; these lose a bit only by a one written to it.
// Assumed: the time-out changes only while disarmed (registers.v), never within a clock of a write to
// the arm register (writes come two clocks apart: bus.v).
reg formal_running = 0, formal_armed = 0, formal_released = 0, formal_fault = 1, formal_write = 0;
reg [23:0] formal_timeout = 0;
reg formal_stops = 1;
reg formal_stopped = 1;         // the filtered emergency stop (filter.v: 18 clocks behind the pin)
reg [24:0] formal_silence = 0;  // clocks since the last pet, or since a new time-out is in force, two after it came
reg [1:0] formal_calm = 0;      // clocks since the time-out changed, at most 3
reg formal_first = 0;           // the last write to the arm register was its first word

reg formal_clean = 0;           // so it was, and no cause has stood since, its own clock included
reg formal_arms = 0;            // the second word came, with no cause standing
reg [7:0] formal_faults = 0, formal_first_fault = 0, formal_clear = 0;

reg formal_stale = 1;           // no pet, and as many ticks since the last as a set point lasts

wire formal_standing = !(|remaining_q) || shortened_q || !released_value || encoder_fault || stall_fault || external_fault;
wire formal_second = arm_write && arm_data == 32'h41524d32;
always @(posedge clock) begin
    formal_running <= 1;
    formal_armed <= armed;
    formal_stops <= stops;
    formal_fault <= encoder_fault || stall_fault || external_fault;
    formal_timeout <= watchdog_timeout;
    formal_stopped <= !released_value;
    formal_silence <= pet || shortened_q || watchdog_timeout != formal_timeout ? 25'd0 : formal_silence + !(&formal_silence);
    formal_calm <= watchdog_timeout != formal_timeout ? 2'd0 : formal_calm + !(&formal_calm);
    if (arm_write) formal_first <= arm_data == 32'h41524d31;
    formal_write <= arm_write;
    formal_clean <= !formal_standing && (arm_write ? arm_data == 32'h41524d31 : formal_clean);
    formal_arms <= formal_second && formal_clean && !formal_standing;
    formal_faults <= faults;
    formal_first_fault <= first_fault;
    formal_clear <= clear_faults;
    formal_stale <= !pet && age_q >= set_point_timeout;
    formal_released <= formal_second && formal_first && released_value && !encoder_fault && !stall_fault && !external_fault;
end

always @(*) begin
    if (formal_running && (formal_armed || formal_write || arm_write)) assume (watchdog_timeout == formal_timeout);
    if (!formal_running) assert (!armed && !setpoints_valid);
    if (formal_stopped || formal_fault) assert (!armed);
    // What the pins see of it.
    assert (armed == !formal_stops && off == formal_stops);
    assert (released_pin == !emergency_stop && released_tick && !released_load);
    if (armed) assert (formal_silence <= watchdog_timeout);
    if (armed && !formal_armed) assert (formal_released);
    if (formal_arms) assert (armed);
    if (formal_running) assert (!(|(formal_faults & ~formal_clear & ~faults)));
    if (formal_running && |(formal_first_fault & ~formal_clear))
        assert (first_fault == (formal_first_fault & ~formal_clear));
    assert (!(|(first_fault & ~faults)));
    if (setpoints_valid) assert (armed);
    // Stale set points: one clock after their last tick they are not valid, whatever else happens.
    if (formal_stale) assert (!setpoints_valid);
    assert (stopped == !released_value);
    if (armed && formal_running) assert (|watchdog_timeout);
    // Invariants that carry the induction.
    assert (!first_word_q || formal_first);
    assert (first_word_q == formal_clean);
    assert (!(shortened_q && (armed || formal_calm >= 2)));
    assert (formal_calm == 0 || remaining_q <= formal_timeout);
    assert (remaining_q == 0 || shortened_q || {2'd0, remaining_q} + formal_silence <= formal_timeout);
end
