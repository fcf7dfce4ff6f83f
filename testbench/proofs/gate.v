// Whatever can move a motor or fire the kicker: not armed, or no bus clock, and every pin is off.
wire formal_on = |pwm || (registers_mode[3] && |dir) || !(&enable_n) || !kicker_charge_n || !kicker_trigger_n;
reg formal_stops = 1;
always @(posedge lclk) formal_stops <= safety_stops;
// Proof "safety".
always @(*) assume (safety_armed == !formal_stops && safety_off == formal_stops);
// A word is staged in the clock after its write, never where the program stores.
reg formal_blocked = 0, formal_turn = 0, formal_selected = 0;
always @(posedge lclk) begin
    formal_blocked <= sequencer_bus_blocked;
    formal_turn <= radio_turn;
    formal_selected <= radio_selected;
end
// Who commands: a host that does not reaches two registers, and the radio never in a clock of the bus.
always @(*) begin
    // Proof "bus".
    assume (!(bus_write_2 || bus_read) || bus_claims);
    assume (!(bus_write_2 && bus_read) && !(bus_write_2 && blocked));
    // What the copy of the registers gives after a clock that writes it is never wanted: nothing is written in
    // the clock in which a read begins.
    if (bus_read) assert (!registers_write);
    if (sequencer_bus_write) assert (!formal_blocked && (formal_turn || !formal_selected));
    if (radio_selected && registers_write && !radio_turn)
        assert (index == at_arm || index == at_radio);
    if (bus_claims) assert (address == bus_address_2 && write_data == bus_write_data_2 && !radio_writes);
end
always @(*) begin
    if (formal_on) assert (safety_armed && !monitor_lclk_dead);
    if (!kicker_trigger_n) assert (kicker_trigger);
    if (!kicker_charge_n) assert (kicker_charge);
    if (kicker_discharge) assert (kicker_charge_n && kicker_trigger_n);
    assert ((pwm & ~{drives_3_pwm, drives_2_pwm, drives_1_pwm, drives_0_pwm}) == 0);
end
