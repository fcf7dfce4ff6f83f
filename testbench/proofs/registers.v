// What the other proofs assume of the settings: while armed nothing but pulse, kicker control and
// LEDs, interrupts and index capture can change, and strobes come from writes only, a clock after them.
localparam FORMAL_BITS = 11 + 24 + 4 + 4 + 13 + 10 + 24 + 4 + 20 + 24 + 6 + 16 + 16 + 13;
wire [FORMAL_BITS-1:0] formal_locked = {imu_control, tick_period, mode, encoder_filter, pwm_period, pwm_blanking,
    watchdog_timeout, encoder_fault_mask, kicker_lockout, kicker_charge_timeout, clocks_per_microsecond,
    set_point_timeout, stall_window, stall_compare};
reg [FORMAL_BITS-1:0] formal_before;
reg formal_running = 0, formal_armed, formal_wrote, formal_writing;
reg [31:0] formal_data;
reg [5:0] formal_address, formal_address_before = 0;

always @(posedge clock) begin
    formal_running <= 1;
    formal_armed <= armed;
    formal_wrote <= write;
    formal_writing <= writing_q;
    formal_data <= data;
    formal_address <= address;
    formal_address_before <= formal_running ? formal_address : 6'd0;
    formal_before <= formal_locked;
end

always @(*) begin
    if (formal_running && (formal_armed || !formal_writing)) assert (formal_locked == formal_before);
    if (arm_write || select_radio || fire || imu_access || |clear_faults || clear_kicker || |clear_encoder_error || |clear_stall || |index_arm || |clear_interrupt || commit_set_points || commit_configuration)
        assert (writing_q);
    if (formal_running && writing_q) assert (formal_wrote && written == formal_data);
    assert (!(fire && arm_write) && !(commit_set_points && commit_configuration));
    if (|clear_faults) assert (clear_faults == written[7:0]);
    if (fire) assert (written == 32'h4b49434b);
    if (tick_period_written) assert (!armed && writing_q);
    assert (unlocked == !armed);
    if (formal_address_before > 43) assert (read_data == 0);
end
