// rac4i65
// Written from the rust-hdl sources in hdl/src; register map 2.3.
// Do not edit: change the sources and run `racbot generate`.

`default_nettype none

module rac4i65 (
    input wire lclk,
    input wire synclk,
    input wire ads_n,
    input wire blast_n,
    input wire lw_r,
    output wire ready_n,
    output wire int_n,
    inout wire [31:0] lad,
    output wire [7:0] led_n,
    output wire [3:0] dir,
    output wire [3:0] enable_n,
    input wire [3:0] encoder_a,
    input wire [3:0] encoder_b,
    input wire [3:0] encoder_index,
    output wire [3:0] pwm,
    output wire kicker_charge_n,
    output wire kicker_trigger_n,
    output wire kicker_discharge,
    input wire kicker_full,
    input wire emergency_stop,
    input wire ball_sensor,
    input wire radio_rx,
    input wire host_select,
    input wire [3:0] robot_number,
    output wire imu_cs_n,
    output wire imu_sclk,
    output wire imu_mosi,
    input wire imu_miso,
    input wire imu_ready
);

    wire [31:0] lad_out;
    wire lad_drive;
    assign lad = lad_drive ? lad_out : 32'bz;

`ifndef SYNTHESIS
    // synthesis translate_off
    pullup (encoder_a[0]);
    pullup (encoder_a[1]);
    pullup (encoder_a[2]);
    pullup (encoder_a[3]);
    pullup (encoder_b[0]);
    pullup (encoder_b[1]);
    pullup (encoder_b[2]);
    pullup (encoder_b[3]);
    pullup (encoder_index[0]);
    pullup (encoder_index[1]);
    pullup (encoder_index[2]);
    pullup (encoder_index[3]);
    pullup (kicker_full);
    pullup (emergency_stop);
    pullup (ball_sensor);
    pullup (radio_rx);
    pullup (host_select);
    pullup (robot_number[0]);
    pullup (robot_number[1]);
    pullup (robot_number[2]);
    pullup (robot_number[3]);
    pullup (imu_miso);
    pullup (imu_ready);
    // synthesis translate_on
`endif

    rac4i65_core core (
        .lclk(lclk),
        .synclk(synclk),
        .ads_n(ads_n),
        .blast_n(blast_n),
        .lw_r(lw_r),
        .ready_n(ready_n),
        .int_n(int_n),
        .lad_in(lad),
        .lad_out(lad_out),
        .lad_drive(lad_drive),
        .led_n(led_n),
        .dir(dir),
        .enable_n(enable_n),
        .encoder_a(encoder_a),
        .encoder_b(encoder_b),
        .encoder_index(encoder_index),
        .pwm(pwm),
        .kicker_charge_n(kicker_charge_n),
        .kicker_trigger_n(kicker_trigger_n),
        .kicker_discharge(kicker_discharge),
        .kicker_full(kicker_full),
        .emergency_stop(emergency_stop),
        .ball_sensor(ball_sensor),
        .radio_rx(radio_rx),
        .host_select(host_select),
        .robot_number(robot_number),
        .imu_cs_n(imu_cs_n),
        .imu_sclk(imu_sclk),
        .imu_mosi(imu_mosi),
        .imu_miso(imu_miso),
        .imu_ready(imu_ready),
        .board(32'h34493635),
        .clock_hz(32'd33333333)
    );
endmodule

module rac4i65_core (
    input wire lclk,
    input wire synclk,
    input wire [31:0] board,
    input wire [31:0] clock_hz,
    input wire ads_n,
    input wire blast_n,
    input wire lw_r,
    input wire [31:0] lad_in,
    output reg [31:0] lad_out,
    output reg lad_drive,
    output reg ready_n,
    output reg int_n,
    output reg [7:0] led_n,
    input wire [3:0] encoder_a,
    input wire [3:0] encoder_b,
    input wire [3:0] encoder_index,
    output reg [3:0] pwm,
    output reg [3:0] dir,
    output reg [3:0] enable_n,
    output reg kicker_charge_n,
    output reg kicker_trigger_n,
    output reg kicker_discharge,
    input wire kicker_full,
    input wire emergency_stop,
    input wire ball_sensor,
    input wire radio_rx,
    input wire host_select,
    input wire [3:0] robot_number,
    output reg imu_cs_n,
    output reg imu_sclk,
    output reg imu_mosi,
    input wire imu_miso,
    input wire imu_ready
);

    // Constants
    localparam zero = 32'h0;
    localparam live_status = 8'hf;
    localparam sign_30 = 32'hc0000000;
    localparam mask_30 = 32'h3fffffff;
    localparam at_arm = 6'b1110;
    localparam at_radio = 6'b101000;
    localparam none = 4'h0;
    localparam all = 4'hf;
    localparam port_direction = 2'b0;
    localparam port_compare = 2'b1;
    localparam port_angle = 2'b10;

    // Pins of the parts

    wire [31:0] bus_lad_out;
    wire bus_lad_drive;
    wire bus_ready_n;
    wire [13:0] bus_address_2;
    wire bus_read;
    reg [31:0] bus_read_data_2;
    wire bus_write_2;
    wire [31:0] bus_write_data_2;

    wire bus_overrun;
    wire bus_claims;

    reg registers_write;

    wire [31:0] registers_written;
    wire [31:0] registers_read_data;

    wire [23:0] registers_kept_data;

    reg [31:0] registers_commits;

    reg [23:0] registers_radio;
    reg [8:0] registers_imu_status;
    wire [23:0] registers_tick_period;
    wire registers_tick_period_written;
    wire [3:0] registers_mode;
    wire [3:0] registers_encoder_filter;
    wire [3:0] registers_encoder_fault_mask;
    wire [12:0] registers_pwm_period;
    wire [9:0] registers_pwm_blanking;
    wire [23:0] registers_watchdog_timeout;
    wire [3:0] registers_kicker_control;
    wire [13:0] registers_kicker_pulse;
    wire [19:0] registers_kicker_lockout;
    wire [23:0] registers_kicker_charge_timeout;
    wire [5:0] registers_clocks_per_microsecond;
    wire [7:0] registers_leds;
    wire [15:0] registers_set_point_timeout;
    wire [15:0] registers_stall_window;
    wire [12:0] registers_stall_compare;
    wire [1:0] registers_interrupt_enable;
    wire [3:0] registers_clear_stall;
    wire [3:0] registers_index_arm;
    wire [3:0] registers_index_clear;
    wire [1:0] registers_clear_interrupt;
    wire registers_select_radio;
    wire [10:0] registers_imu_control;
    wire registers_imu_access;
    wire registers_arm_write;
    wire [7:0] registers_clear_faults;
    wire registers_clear_kicker;
    wire [3:0] registers_clear_encoder_error;
    wire registers_commit_set_points;
    wire registers_commit_configuration;
    wire registers_fire;

    wire [31:0] timebase_clock_count;
    wire [23:0] timebase_period;
    wire timebase_tick;
    wire timebase_microsecond;
    wire timebase_window;

    wire decoder_at_registers;
    wire decoder_in_registers;
    wire decoder_in_memory;
    wire decoder_in_imu;
    wire [7:0] decoder_memory_address;
    wire [7:0] decoder_staging_address;
    wire decoder_stages_set_point;
    wire decoder_stages_configuration;
    wire [5:0] decoder_word;
    wire [13:0] decoder_staging_word;
    wire decoder_snapshot_first;
    wire decoder_snapshot_last;

    reg commit_stage_set_point;
    reg commit_stage_configuration;

    wire commit_set_point_bank;
    wire commit_configuration_bank;
    wire commit_set_points_pending;
    wire commit_configuration_pending;
    wire commit_pet;
    wire commit_fault_2;
    wire [15:0] commit_accepted;
    wire [15:0] commit_rejected;

    wire [1:0] snapshot_write_bank;
    wire [1:0] snapshot_read_bank;

    wire safety_armed;
    wire safety_stops;
    wire safety_off;
    wire safety_setpoints_valid;
    wire [7:0] safety_faults;
    wire [7:0] safety_first_fault;
    wire safety_stopped;

    reg kicker_charge_request;

    reg kicker_arm_on_ball;

    reg kicker_by_time;
    wire kicker_charge;
    wire kicker_trigger;
    wire kicker_ready;
    wire [2:0] kicker_state;
    wire kicker_timed_out;
    wire kicker_dropped;
    wire kicker_is_full;
    wire kicker_on_ball;

    wire monitor_lclk_dead;

    wire sequencer_running;
    wire sequencer_done;

    wire [4:0] sequencer_input_port;
    wire [1:0] sequencer_axis;
    reg [31:0] sequencer_input_data;
    wire sequencer_output_strobe;
    wire [1:0] sequencer_output_port;
    wire [31:0] sequencer_output_data;

    wire [31:0] sequencer_bus_read_data;

    reg sequencer_bus_write;

    wire sequencer_bus_blocked;

    reg trigonometry_load;

    wire [17:0] trigonometry_sine;
    wire [17:0] trigonometry_cosine;
    wire [17:0] trigonometry_fraction;

    wire interrupt_int_n;
    wire [1:0] interrupt_status_2;

    reg radio_select;
    wire radio_offer;
    wire [13:0] radio_address;
    wire [31:0] radio_data;
    wire radio_selected;
    wire [7:0] radio_accepted;
    wire [7:0] radio_dropped;

    reg imu_enable;
    reg imu_idle_high;
    reg [1:0] imu_half;
    reg [6:0] imu_first;

    reg [15:0] imu_command;

    reg [2:0] imu_read_word;
    wire imu_cs_n_2;
    wire imu_sclk_2;
    wire imu_mosi_2;
    wire imu_busy;
    wire imu_reading;
    wire [7:0] imu_value;
    wire [15:0] imu_read_data;

    reg encoders_0_a;
    reg encoders_0_b;

    reg [23:0] encoders_0_now;
    reg encoders_0_clear_error;
    reg encoders_0_index;
    reg encoders_0_arm_index;
    wire [15:0] encoders_0_count;
    wire [23:0] encoders_0_edge_time;
    wire encoders_0_direction;
    wire encoders_0_error;
    wire encoders_0_live_a;
    wire encoders_0_live_b;
    wire encoders_0_step;
    wire encoders_0_up;
    wire encoders_0_live_index;
    wire [15:0] encoders_0_index_count;
    wire encoders_0_index_event;
    wire encoders_0_index_waiting;
    wire encoders_0_index_seen;

    reg encoders_1_a;
    reg encoders_1_b;

    reg [23:0] encoders_1_now;
    reg encoders_1_clear_error;
    reg encoders_1_index;
    reg encoders_1_arm_index;
    wire [15:0] encoders_1_count;
    wire [23:0] encoders_1_edge_time;
    wire encoders_1_direction;
    wire encoders_1_error;
    wire encoders_1_live_a;
    wire encoders_1_live_b;
    wire encoders_1_step;
    wire encoders_1_up;
    wire encoders_1_live_index;
    wire [15:0] encoders_1_index_count;
    wire encoders_1_index_event;
    wire encoders_1_index_waiting;
    wire encoders_1_index_seen;

    reg encoders_2_a;
    reg encoders_2_b;

    reg [23:0] encoders_2_now;
    reg encoders_2_clear_error;
    reg encoders_2_index;
    reg encoders_2_arm_index;
    wire [15:0] encoders_2_count;
    wire [23:0] encoders_2_edge_time;
    wire encoders_2_direction;
    wire encoders_2_error;
    wire encoders_2_live_a;
    wire encoders_2_live_b;
    wire encoders_2_step;
    wire encoders_2_up;
    wire encoders_2_live_index;
    wire [15:0] encoders_2_index_count;
    wire encoders_2_index_event;
    wire encoders_2_index_waiting;
    wire encoders_2_index_seen;

    reg encoders_3_a;
    reg encoders_3_b;

    reg [23:0] encoders_3_now;
    reg encoders_3_clear_error;
    reg encoders_3_index;
    reg encoders_3_arm_index;
    wire [15:0] encoders_3_count;
    wire [23:0] encoders_3_edge_time;
    wire encoders_3_direction;
    wire encoders_3_error;
    wire encoders_3_live_a;
    wire encoders_3_live_b;
    wire encoders_3_step;
    wire encoders_3_up;
    wire encoders_3_live_index;
    wire [15:0] encoders_3_index_count;
    wire encoders_3_index_event;
    wire encoders_3_index_waiting;
    wire encoders_3_index_seen;

    reg stalls_0_load;

    reg stalls_0_clear;
    wire stalls_0_stalled;

    reg stalls_1_load;

    reg stalls_1_clear;
    wire stalls_1_stalled;

    reg stalls_2_load;

    reg stalls_2_clear;
    wire stalls_2_stalled;

    reg stalls_3_load;

    reg stalls_3_clear;
    wire stalls_3_stalled;

    reg drives_0_load;

    reg drives_0_sync;
    reg drives_0_up_down;
    wire drives_0_pwm;
    wire drives_0_dir;
    wire drives_0_period_start;
    wire [12:0] drives_0_position;

    reg drives_1_load;

    reg drives_1_sync;
    reg drives_1_up_down;
    wire drives_1_pwm;
    wire drives_1_dir;
    wire drives_1_period_start;
    wire [12:0] drives_1_position;

    reg drives_2_load;

    reg drives_2_sync;
    reg drives_2_up_down;
    wire drives_2_pwm;
    wire drives_2_dir;
    wire drives_2_period_start;
    wire [12:0] drives_2_position;

    reg drives_3_load;

    reg drives_3_sync;
    reg drives_3_up_down;
    wire drives_3_pwm;
    wire drives_3_dir;
    wire drives_3_period_start;
    wire [12:0] drives_3_position;
    reg [3:0] clear_at_tick_d;
    wire [3:0] clear_at_tick_q;

    reg [7:0] status_at_tick_d;
    wire [7:0] status_at_tick_q;

    reg [7:0] faults_at_tick_d;
    wire [7:0] faults_at_tick_q;

    reg [23:0] now_d;
    wire [23:0] now_q;

    reg reverse_d;
    wire reverse_q;

    reg stages_d;
    wire stages_q;

    reg encoder_fault_d;
    wire encoder_fault_q;

    reg stall_fault_d;
    wire stall_fault_q;

    reg read_memory_d;
    wire read_memory_q;

    reg read_imu_d;
    wire read_imu_q;

    reg finished_d;
    wire finished_q;

    reg stop_sync_d;
    wire stop_sync_q;

    reg stop_live_d;
    wire stop_live_q;

    reg ball_sync_d;
    wire ball_sync_q;

    reg ball_live_d;
    wire ball_live_q;

    reg dead_sync_d;
    wire dead_sync_q;

    reg dead_live_d;
    wire dead_live_q;

    reg second_starts_d;
    wire second_starts_q;

    reg third_starts_d;
    wire third_starts_q;

    reg fourth_starts_d;
    wire fourth_starts_q;

    reg [12:0] three_quarters_d;
    wire [12:0] three_quarters_q;

    reg [15:0] line_d;
    wire [15:0] line_q;

    // Intermediate values
    reg tick;
    reg snapshot_done;
    reg alive;
    reg radio_turn;
    reg [13:0] address;
    reg [5:0] index;
    reg [31:0] write_data;
    reg host_writes;
    reg blocked;
    reg radio_writes;
    reg [31:0] staged;
    reg [31:0] memory_word;
    reg [31:0] imu_word;
    reg [7:0] status;
    reg [7:0] kicker_status;
    reg [3:0] errors;
    reg [11:0] lines;
    reg [3:0] masked_errors;
    reg [15:0] count;
    reg [23:0] edge_time;
    reg direction;
    reg [15:0] index_count;
    reg index_event;
    reg index_clear;
    reg [3:0] indices;
    reg [7:0] index_status;
    reg [3:0] stalled;
    reg [3:0] masked_stalls;
    reg [12:0] quarter;
    reg [12:0] half;
    reg shut;
    reg holds;
    reg [12:0] compare;
    reg [3:0] pwm_pins;
    reg [3:0] dir_pins;

    // Parts
    rac4i65_core_bus bus(
        .clock(lclk),
        .ads_n(ads_n),
        .blast_n(blast_n),
        .lw_r(lw_r),
        .lad_in(lad_in),
        .lad_out(bus_lad_out),
        .lad_drive(bus_lad_drive),
        .ready_n(bus_ready_n),
        .address(bus_address_2),
        .read(bus_read),
        .read_data(bus_read_data_2),
        .write(bus_write_2),
        .write_data(bus_write_data_2),
        .write_busy(blocked),
        .overrun(bus_overrun),
        .claims(bus_claims)
    );
    rac4i65_core_registers registers(
        .clock(lclk),
        .address(index),
        .write(registers_write),
        .data(write_data),
        .written(registers_written),
        .read_data(registers_read_data),
        .was_in_page(decoder_in_registers),
        .kept_data(registers_kept_data),
        .armed(safety_armed),
        .board(board),
        .clock_hz(clock_hz),
        .clock_count(timebase_clock_count),
        .faults(safety_faults),
        .first_fault(safety_first_fault),
        .status(status),
        .commits(registers_commits),
        .encoder_error(errors),
        .encoder_lines(lines),
        .kicker_status(kicker_status),
        .stall(stalled),
        .index_status(index_status),
        .interrupt_status(interrupt_status_2),
        .radio(registers_radio),
        .imu_status(registers_imu_status),
        .tick_period(registers_tick_period),
        .tick_period_written(registers_tick_period_written),
        .mode(registers_mode),
        .encoder_filter(registers_encoder_filter),
        .encoder_fault_mask(registers_encoder_fault_mask),
        .pwm_period(registers_pwm_period),
        .pwm_blanking(registers_pwm_blanking),
        .watchdog_timeout(registers_watchdog_timeout),
        .kicker_control(registers_kicker_control),
        .kicker_pulse(registers_kicker_pulse),
        .kicker_lockout(registers_kicker_lockout),
        .kicker_charge_timeout(registers_kicker_charge_timeout),
        .clocks_per_microsecond(registers_clocks_per_microsecond),
        .leds(registers_leds),
        .set_point_timeout(registers_set_point_timeout),
        .stall_window(registers_stall_window),
        .stall_compare(registers_stall_compare),
        .interrupt_enable(registers_interrupt_enable),
        .clear_stall(registers_clear_stall),
        .index_arm(registers_index_arm),
        .index_clear(registers_index_clear),
        .clear_interrupt(registers_clear_interrupt),
        .select_radio(registers_select_radio),
        .imu_control(registers_imu_control),
        .imu_access(registers_imu_access),
        .arm_write(registers_arm_write),
        .clear_faults(registers_clear_faults),
        .clear_kicker(registers_clear_kicker),
        .clear_encoder_error(registers_clear_encoder_error),
        .commit_set_points(registers_commit_set_points),
        .commit_configuration(registers_commit_configuration),
        .fire(registers_fire)
    );
    rac4i65_core_timebase timebase(
        .clock(lclk),
        .tick_period(registers_tick_period),
        .restart(registers_tick_period_written),
        .clocks_per_microsecond(registers_clocks_per_microsecond),
        .stall_window(registers_stall_window),
        .clock_count(timebase_clock_count),
        .period(timebase_period),
        .tick(timebase_tick),
        .microsecond(timebase_microsecond),
        .window(timebase_window)
    );
    rac4i65_core_decoder decoder(
        .clock(lclk),
        .address(address),
        .read(bus_read),
        .configuration_bank(commit_configuration_bank),
        .set_point_bank(commit_set_point_bank),
        .snapshot_bank(snapshot_read_bank),
        .at_registers(decoder_at_registers),
        .in_registers(decoder_in_registers),
        .in_memory(decoder_in_memory),
        .in_imu(decoder_in_imu),
        .memory_address(decoder_memory_address),
        .staging_address(decoder_staging_address),
        .stages_set_point(decoder_stages_set_point),
        .stages_configuration(decoder_stages_configuration),
        .word(decoder_word),
        .staging_word(decoder_staging_word),
        .snapshot_first(decoder_snapshot_first),
        .snapshot_last(decoder_snapshot_last)
    );
    rac4i65_core_commit commit(
        .clock(lclk),
        .stage_set_point(commit_stage_set_point),
        .stage_configuration(commit_stage_configuration),
        .commit_set_points(registers_commit_set_points),
        .commit_configuration(registers_commit_configuration),
        .address(decoder_staging_word),
        .data(registers_written),
        .checksum(registers_written),
        .tick(tick),
        .set_point_bank(commit_set_point_bank),
        .configuration_bank(commit_configuration_bank),
        .set_points_pending(commit_set_points_pending),
        .configuration_pending(commit_configuration_pending),
        .pet(commit_pet),
        .fault(commit_fault_2),
        .accepted(commit_accepted),
        .rejected(commit_rejected)
    );
    rac4i65_core_snapshot snapshot(
        .clock(lclk),
        .tick(tick),
        .done(snapshot_done),
        .read_first(decoder_snapshot_first),
        .read_last(decoder_snapshot_last),
        .write_bank(snapshot_write_bank),
        .read_bank(snapshot_read_bank)
    );
    rac4i65_core_safety safety(
        .clock(lclk),
        .emergency_stop(emergency_stop),
        .arm_write(registers_arm_write),
        .arm_data(registers_written),
        .pet(commit_pet),
        .watchdog_timeout(registers_watchdog_timeout),
        .encoder_fault(encoder_fault_q),
        .stall_fault(stall_fault_q),
        .commit_fault(commit_fault_2),
        .external_fault(dead_live_q),
        .clear_faults(registers_clear_faults),
        .tick(tick),
        .set_point_timeout(registers_set_point_timeout),
        .armed(safety_armed),
        .stops(safety_stops),
        .off(safety_off),
        .setpoints_valid(safety_setpoints_valid),
        .faults(safety_faults),
        .first_fault(safety_first_fault),
        .stopped(safety_stopped)
    );
    rac4i65_core_kicker kicker(
        .clock(lclk),
        .enable(safety_armed),
        .microsecond(timebase_microsecond),
        .charge_request(kicker_charge_request),
        .charge_timeout(registers_kicker_charge_timeout),
        .fire(registers_fire),
        .pulse(registers_kicker_pulse),
        .lockout(registers_kicker_lockout),
        .ball(ball_sensor),
        .arm_on_ball(kicker_arm_on_ball),
        .clear(registers_clear_kicker),
        .full(kicker_full),
        .by_time(kicker_by_time),
        .charge(kicker_charge),
        .trigger(kicker_trigger),
        .ready(kicker_ready),
        .state(kicker_state),
        .timed_out(kicker_timed_out),
        .dropped(kicker_dropped),
        .is_full(kicker_is_full),
        .on_ball(kicker_on_ball)
    );
    rac4i65_core_monitor monitor (.lclk(lclk), .synclk(synclk), .lclk_dead(monitor_lclk_dead));
    rac4i65_core_sequencer sequencer(
        .clock(lclk),
        .tick(tick),
        .running(sequencer_running),
        .done(sequencer_done),
        .configuration_bank(commit_configuration_bank),
        .set_point_bank(commit_set_point_bank),
        .snapshot_bank(snapshot_write_bank),
        .input_port(sequencer_input_port),
        .axis(sequencer_axis),
        .input_data(sequencer_input_data),
        .output_strobe(sequencer_output_strobe),
        .output_port(sequencer_output_port),
        .output_data(sequencer_output_data),
        .bus_address(decoder_memory_address),
        .bus_read_data(sequencer_bus_read_data),
        .bus_write_address(decoder_staging_address),
        .bus_write(sequencer_bus_write),
        .bus_write_data(staged),
        .bus_blocked(sequencer_bus_blocked)
    );
    rac4i65_core_trigonometry trigonometry(
        .clock(lclk),
        .load(trigonometry_load),
        .angle(sequencer_output_data),
        .sine(trigonometry_sine),
        .cosine(trigonometry_cosine),
        .fraction(trigonometry_fraction)
    );
    rac4i65_core_interrupt interrupt(
        .clock(lclk),
        .done(snapshot_done),
        .armed(safety_armed),
        .enable(registers_interrupt_enable),
        .clear(registers_clear_interrupt),
        .int_n(interrupt_int_n),
        .status(interrupt_status_2)
    );
    rac4i65_core_radio radio(
        .clock(lclk),
        .rx(radio_rx),
        .host_select(host_select),
        .robot(robot_number),
        .armed(safety_armed),
        .taken(radio_writes),
        .select_write(registers_select_radio),
        .select(radio_select),
        .offer(radio_offer),
        .address(radio_address),
        .data(radio_data),
        .selected(radio_selected),
        .accepted(radio_accepted),
        .dropped(radio_dropped)
    );
    rac4i65_core_imu imu(
        .clock(lclk),
        .tick(tick),
        .bank(snapshot_write_bank),
        .enable(imu_enable),
        .idle_high(imu_idle_high),
        .half(imu_half),
        .first(imu_first),
        .access(registers_imu_access),
        .command(imu_command),
        .miso(imu_miso),
        .ready(imu_ready),
        .read_bank(snapshot_read_bank),
        .read_word(imu_read_word),
        .cs_n(imu_cs_n_2),
        .sclk(imu_sclk_2),
        .mosi(imu_mosi_2),
        .busy(imu_busy),
        .reading(imu_reading),
        .value(imu_value),
        .read_data(imu_read_data)
    );
    rac4i65_core_encoders encoders_0(
        .clock(lclk),
        .a(encoders_0_a),
        .b(encoders_0_b),
        .filter(registers_encoder_filter),
        .sample(tick),
        .now(encoders_0_now),
        .clear_error(encoders_0_clear_error),
        .index(encoders_0_index),
        .arm_index(encoders_0_arm_index),
        .count(encoders_0_count),
        .edge_time(encoders_0_edge_time),
        .direction(encoders_0_direction),
        .error(encoders_0_error),
        .live_a(encoders_0_live_a),
        .live_b(encoders_0_live_b),
        .step(encoders_0_step),
        .up(encoders_0_up),
        .live_index(encoders_0_live_index),
        .index_count(encoders_0_index_count),
        .index_event(encoders_0_index_event),
        .index_waiting(encoders_0_index_waiting),
        .index_seen(encoders_0_index_seen)
    );
    rac4i65_core_encoders encoders_1(
        .clock(lclk),
        .a(encoders_1_a),
        .b(encoders_1_b),
        .filter(registers_encoder_filter),
        .sample(tick),
        .now(encoders_1_now),
        .clear_error(encoders_1_clear_error),
        .index(encoders_1_index),
        .arm_index(encoders_1_arm_index),
        .count(encoders_1_count),
        .edge_time(encoders_1_edge_time),
        .direction(encoders_1_direction),
        .error(encoders_1_error),
        .live_a(encoders_1_live_a),
        .live_b(encoders_1_live_b),
        .step(encoders_1_step),
        .up(encoders_1_up),
        .live_index(encoders_1_live_index),
        .index_count(encoders_1_index_count),
        .index_event(encoders_1_index_event),
        .index_waiting(encoders_1_index_waiting),
        .index_seen(encoders_1_index_seen)
    );
    rac4i65_core_encoders encoders_2(
        .clock(lclk),
        .a(encoders_2_a),
        .b(encoders_2_b),
        .filter(registers_encoder_filter),
        .sample(tick),
        .now(encoders_2_now),
        .clear_error(encoders_2_clear_error),
        .index(encoders_2_index),
        .arm_index(encoders_2_arm_index),
        .count(encoders_2_count),
        .edge_time(encoders_2_edge_time),
        .direction(encoders_2_direction),
        .error(encoders_2_error),
        .live_a(encoders_2_live_a),
        .live_b(encoders_2_live_b),
        .step(encoders_2_step),
        .up(encoders_2_up),
        .live_index(encoders_2_live_index),
        .index_count(encoders_2_index_count),
        .index_event(encoders_2_index_event),
        .index_waiting(encoders_2_index_waiting),
        .index_seen(encoders_2_index_seen)
    );
    rac4i65_core_encoders encoders_3(
        .clock(lclk),
        .a(encoders_3_a),
        .b(encoders_3_b),
        .filter(registers_encoder_filter),
        .sample(tick),
        .now(encoders_3_now),
        .clear_error(encoders_3_clear_error),
        .index(encoders_3_index),
        .arm_index(encoders_3_arm_index),
        .count(encoders_3_count),
        .edge_time(encoders_3_edge_time),
        .direction(encoders_3_direction),
        .error(encoders_3_error),
        .live_a(encoders_3_live_a),
        .live_b(encoders_3_live_b),
        .step(encoders_3_step),
        .up(encoders_3_up),
        .live_index(encoders_3_live_index),
        .index_count(encoders_3_index_count),
        .index_event(encoders_3_index_event),
        .index_waiting(encoders_3_index_waiting),
        .index_seen(encoders_3_index_seen)
    );
    rac4i65_core_stalls stalls_0(
        .clock(lclk),
        .enable(safety_armed),
        .step(encoders_0_step),
        .up(encoders_0_up),
        .load(stalls_0_load),
        .compare(compare),
        .threshold(registers_stall_compare),
        .window(timebase_window),
        .clear(stalls_0_clear),
        .stalled(stalls_0_stalled)
    );
    rac4i65_core_stalls stalls_1(
        .clock(lclk),
        .enable(safety_armed),
        .step(encoders_1_step),
        .up(encoders_1_up),
        .load(stalls_1_load),
        .compare(compare),
        .threshold(registers_stall_compare),
        .window(timebase_window),
        .clear(stalls_1_clear),
        .stalled(stalls_1_stalled)
    );
    rac4i65_core_stalls stalls_2(
        .clock(lclk),
        .enable(safety_armed),
        .step(encoders_2_step),
        .up(encoders_2_up),
        .load(stalls_2_load),
        .compare(compare),
        .threshold(registers_stall_compare),
        .window(timebase_window),
        .clear(stalls_2_clear),
        .stalled(stalls_2_stalled)
    );
    rac4i65_core_stalls stalls_3(
        .clock(lclk),
        .enable(safety_armed),
        .step(encoders_3_step),
        .up(encoders_3_up),
        .load(stalls_3_load),
        .compare(compare),
        .threshold(registers_stall_compare),
        .window(timebase_window),
        .clear(stalls_3_clear),
        .stalled(stalls_3_stalled)
    );
    rac4i65_core_drives drives_0(
        .clock(lclk),
        .enable(safety_armed),
        .stops(safety_stops),
        .period(registers_pwm_period),
        .blanking(registers_pwm_blanking),
        .load(drives_0_load),
        .compare(compare),
        .direction(reverse_q),
        .sync(drives_0_sync),
        .up_down(drives_0_up_down),
        .pwm(drives_0_pwm),
        .dir(drives_0_dir),
        .period_start(drives_0_period_start),
        .position(drives_0_position)
    );
    rac4i65_core_drives drives_1(
        .clock(lclk),
        .enable(safety_armed),
        .stops(safety_stops),
        .period(registers_pwm_period),
        .blanking(registers_pwm_blanking),
        .load(drives_1_load),
        .compare(compare),
        .direction(reverse_q),
        .sync(drives_1_sync),
        .up_down(drives_1_up_down),
        .pwm(drives_1_pwm),
        .dir(drives_1_dir),
        .period_start(drives_1_period_start),
        .position(drives_1_position)
    );
    rac4i65_core_drives drives_2(
        .clock(lclk),
        .enable(safety_armed),
        .stops(safety_stops),
        .period(registers_pwm_period),
        .blanking(registers_pwm_blanking),
        .load(drives_2_load),
        .compare(compare),
        .direction(reverse_q),
        .sync(drives_2_sync),
        .up_down(drives_2_up_down),
        .pwm(drives_2_pwm),
        .dir(drives_2_dir),
        .period_start(drives_2_period_start),
        .position(drives_2_position)
    );
    rac4i65_core_drives drives_3(
        .clock(lclk),
        .enable(safety_armed),
        .stops(safety_stops),
        .period(registers_pwm_period),
        .blanking(registers_pwm_blanking),
        .load(drives_3_load),
        .compare(compare),
        .direction(reverse_q),
        .sync(drives_3_sync),
        .up_down(drives_3_up_down),
        .pwm(drives_3_pwm),
        .dir(drives_3_dir),
        .period_start(drives_3_period_start),
        .position(drives_3_position)
    );
    rac4i65_core_dff_4 clear_at_tick (.d(clear_at_tick_d), .q(clear_at_tick_q), .clock(lclk));
    rac4i65_core_dff_8 status_at_tick (.d(status_at_tick_d), .q(status_at_tick_q), .clock(lclk));
    rac4i65_core_dff_8 faults_at_tick (.d(faults_at_tick_d), .q(faults_at_tick_q), .clock(lclk));
    rac4i65_core_dff_24_2 now (.d(now_d), .q(now_q), .clock(lclk));
    rac4i65_core_dff_1 reverse (.d(reverse_d), .q(reverse_q), .clock(lclk));
    rac4i65_core_dff_1 stages (.d(stages_d), .q(stages_q), .clock(lclk));
    rac4i65_core_dff_1 encoder_fault (.d(encoder_fault_d), .q(encoder_fault_q), .clock(lclk));
    rac4i65_core_dff_1 stall_fault (.d(stall_fault_d), .q(stall_fault_q), .clock(lclk));
    rac4i65_core_dff_1 read_memory (.d(read_memory_d), .q(read_memory_q), .clock(lclk));
    rac4i65_core_dff_1 read_imu (.d(read_imu_d), .q(read_imu_q), .clock(lclk));
    rac4i65_core_dff_1 finished (.d(finished_d), .q(finished_q), .clock(lclk));
    rac4i65_core_dff_1 stop_sync (.d(stop_sync_d), .q(stop_sync_q), .clock(lclk));
    rac4i65_core_dff_1 stop_live (.d(stop_live_d), .q(stop_live_q), .clock(lclk));
    rac4i65_core_dff_1 ball_sync (.d(ball_sync_d), .q(ball_sync_q), .clock(lclk));
    rac4i65_core_dff_1 ball_live (.d(ball_live_d), .q(ball_live_q), .clock(lclk));
    rac4i65_core_dff_1 dead_sync (.d(dead_sync_d), .q(dead_sync_q), .clock(lclk));
    rac4i65_core_dff_1 dead_live (.d(dead_live_d), .q(dead_live_q), .clock(lclk));
    rac4i65_core_dff_1 second_starts (.d(second_starts_d), .q(second_starts_q), .clock(lclk));
    rac4i65_core_dff_1 third_starts (.d(third_starts_d), .q(third_starts_q), .clock(lclk));
    rac4i65_core_dff_1 fourth_starts (.d(fourth_starts_d), .q(fourth_starts_q), .clock(lclk));
    rac4i65_core_dff_13 three_quarters (.d(three_quarters_d), .q(three_quarters_q), .clock(lclk));
    rac4i65_core_dff_16 line (.d(line_d), .q(line_q), .clock(lclk));

    always @(*) begin
        clear_at_tick_d = clear_at_tick_q;
        status_at_tick_d = status_at_tick_q;
        faults_at_tick_d = faults_at_tick_q;
        now_d = now_q;
        if (tick) begin
            status_at_tick_d = status & live_status;
            clear_at_tick_d = registers_index_clear;
            faults_at_tick_d = safety_faults;
            now_d = timebase_clock_count[(32'h0)+:(24)];
        end
        drives_0_sync = 1'b0;
    end

    always @(*) begin
        line_d = line_q;
        line_d = count - ((direction) & 16'hffff);
    end

    always @(*) begin
        reverse_d = reverse_q;
        if (sequencer_output_strobe & (sequencer_output_port == port_direction)) begin
            reverse_d = sequencer_output_data[32'h1f];
        end
    end

    always @(*) begin
        stages_d = stages_q;
        stages_d = radio_writes | (bus_write_2 & ~radio_selected);
    end

    always @(*) begin
        encoder_fault_d = encoder_fault_q;
        encoder_fault_d = masked_errors != none;
    end

    always @(*) begin
        stall_fault_d = stall_fault_q;
        stall_fault_d = masked_stalls != none;
    end

    always @(*) begin
        read_memory_d = read_memory_q;
        read_memory_d = decoder_in_memory;
    end

    always @(*) begin
        read_imu_d = read_imu_q;
        read_imu_d = decoder_in_imu;
    end

    always @(*) begin
        finished_d = finished_q;
        finished_d = (sequencer_done | finished_q) & imu_reading;
    end

    always @(*) begin
        stop_sync_d = stop_sync_q;
        stop_sync_d = emergency_stop;
    end

    always @(*) begin
        stop_live_d = stop_live_q;
        stop_live_d = stop_sync_q;
    end

    always @(*) begin
        ball_sync_d = ball_sync_q;
        ball_sync_d = ball_sensor;
    end

    always @(*) begin
        ball_live_d = ball_live_q;
        ball_live_d = ball_sync_q;
    end

    always @(*) begin
        dead_sync_d = dead_sync_q;
        dead_sync_d = monitor_lclk_dead;
    end

    always @(*) begin
        second_starts_d = second_starts_q;
        second_starts_d = drives_0_position == quarter;
    end

    always @(*) begin
        third_starts_d = third_starts_q;
        third_starts_d = drives_0_position == half;
    end

    always @(*) begin
        fourth_starts_d = fourth_starts_q;
        fourth_starts_d = drives_0_position == three_quarters_q;
    end

    always @(*) begin
        three_quarters_d = three_quarters_q;
        three_quarters_d = half + quarter;
    end

    always @(*) begin
        dead_live_d = dead_live_q;
        dead_live_d = dead_sync_q;
    end

    always @(*) lad_out = bus_lad_out;
    always @(*) lad_drive = bus_lad_drive;
    always @(*) ready_n = bus_ready_n;
    always @(*) snapshot_done = (sequencer_done | finished_q) & ~imu_reading;
    always @(*) int_n = interrupt_int_n;
    always @(*) led_n = ~registers_leds;
    always @(*) status = ((safety_armed) & 8'hff) | (((safety_setpoints_valid) & 8'hff) << 32'h1) | (((stop_live_q) & 8'hff) << 32'h2) | (((ball_live_q) & 8'hff) << 32'h3) | (((commit_set_points_pending) & 8'hff) << 32'h4) | (((commit_configuration_pending) & 8'hff) << 32'h5);
    always @(*) tick = timebase_tick & ~sequencer_running;
    always @(*) radio_turn = radio_offer & ~bus_claims;

    always @(*) begin
        address = bus_address_2;
        write_data = bus_write_data_2;
        if (~bus_claims) begin
            address = radio_address;
            write_data = radio_data;
        end
    end

    always @(*) index = address[(32'h0)+:(6)];
    always @(*) host_writes = bus_write_2 & (~radio_selected | (index == at_arm) | (index == at_radio));
    always @(*) blocked = sequencer_bus_blocked;
    always @(*) radio_writes = radio_turn & ~blocked;
    always @(*) registers_write = decoder_at_registers & (host_writes | radio_writes);

    always @(*) begin
        staged = registers_written & mask_30;
        if (registers_written[32'h1d]) begin
            staged = registers_written | sign_30;
        end
    end

    always @(*) begin
        radio_select = registers_written[32'h0];
        imu_command = registers_written[(32'h0)+:(16)];
    end

    always @(*) sequencer_bus_write = stages_q & (decoder_stages_set_point | decoder_stages_configuration);
    always @(*) commit_stage_set_point = stages_q & decoder_stages_set_point;
    always @(*) commit_stage_configuration = stages_q & decoder_stages_configuration;

    always @(*) begin
        memory_word = zero;
        if (read_memory_q) begin
            memory_word = sequencer_bus_read_data;
        end
    end

    always @(*) begin
        imu_word = zero;
        if (read_imu_q) begin
            imu_word = ((imu_read_data) & 32'hffffffff);
        end
    end

    always @(*) bus_read_data_2 = registers_read_data | ((registers_kept_data) & 32'hffffffff) | memory_word | imu_word;

    always @(*) begin
        imu_enable = registers_imu_control[32'h0];
        imu_idle_high = registers_imu_control[32'h1];
        imu_half = registers_imu_control[(32'h2)+:(2)];
        imu_first = registers_imu_control[(32'h4)+:(7)];
    end

    always @(*) imu_read_word = decoder_word[(32'h0)+:(3)];
    always @(*) imu_cs_n = imu_cs_n_2;
    always @(*) imu_sclk = imu_sclk_2;
    always @(*) imu_mosi = imu_mosi_2;

    always @(*) begin
        encoders_0_a = encoder_a[0];
        encoders_1_a = encoder_a[1];
        encoders_2_a = encoder_a[2];
        encoders_3_a = encoder_a[3];
    end

    always @(*) begin
        encoders_0_b = encoder_b[0];
        encoders_1_b = encoder_b[1];
        encoders_2_b = encoder_b[2];
        encoders_3_b = encoder_b[3];
    end

    always @(*) begin
        encoders_0_now = timebase_clock_count[(32'h0)+:(24)];
        encoders_1_now = timebase_clock_count[(32'h0)+:(24)];
        encoders_2_now = timebase_clock_count[(32'h0)+:(24)];
        encoders_3_now = timebase_clock_count[(32'h0)+:(24)];
    end

    always @(*) begin
        encoders_0_clear_error = registers_clear_encoder_error[0];
        encoders_1_clear_error = registers_clear_encoder_error[1];
        encoders_2_clear_error = registers_clear_encoder_error[2];
        encoders_3_clear_error = registers_clear_encoder_error[3];
    end

    always @(*) begin
        encoders_0_index = encoder_index[0];
        encoders_1_index = encoder_index[1];
        encoders_2_index = encoder_index[2];
        encoders_3_index = encoder_index[3];
    end

    always @(*) begin
        encoders_0_arm_index = registers_index_arm[0];
        encoders_1_arm_index = registers_index_arm[1];
        encoders_2_arm_index = registers_index_arm[2];
        encoders_3_arm_index = registers_index_arm[3];
    end

    always @(*) begin
        stalls_0_clear = registers_clear_stall[0];
        stalls_1_clear = registers_clear_stall[1];
        stalls_2_clear = registers_clear_stall[2];
        stalls_3_clear = registers_clear_stall[3];
    end

    always @(*) indices = ((encoders_0_live_index) & 4'hf) | (((encoders_1_live_index) & 4'hf) << 32'h1) | (((encoders_2_live_index) & 4'hf) << 32'h2) | (((encoders_3_live_index) & 4'hf) << 32'h3);
    always @(*) index_status = ((encoders_0_index_waiting) & 8'hff) | (((encoders_1_index_waiting) & 8'hff) << 32'h1) | (((encoders_2_index_waiting) & 8'hff) << 32'h2) | (((encoders_3_index_waiting) & 8'hff) << 32'h3) | (((encoders_0_index_seen) & 8'hff) << 32'h4) | (((encoders_1_index_seen) & 8'hff) << 32'h5) | (((encoders_2_index_seen) & 8'hff) << 32'h6) | (((encoders_3_index_seen) & 8'hff) << 32'h7);
    always @(*) stalled = ((stalls_0_stalled) & 4'hf) | (((stalls_1_stalled) & 4'hf) << 32'h1) | (((stalls_2_stalled) & 4'hf) << 32'h2) | (((stalls_3_stalled) & 4'hf) << 32'h3);
    always @(*) masked_stalls = stalled & registers_encoder_fault_mask;
    always @(*) errors = ((encoders_0_error) & 4'hf) | (((encoders_1_error) & 4'hf) << 32'h1) | (((encoders_2_error) & 4'hf) << 32'h2) | (((encoders_3_error) & 4'hf) << 32'h3);
    always @(*) lines = ((encoders_0_live_a) & 12'hfff) | (((encoders_0_live_b) & 12'hfff) << 32'h1) | (((encoders_1_live_a) & 12'hfff) << 32'h2) | (((encoders_1_live_b) & 12'hfff) << 32'h3) | (((encoders_2_live_a) & 12'hfff) << 32'h4) | (((encoders_2_live_b) & 12'hfff) << 32'h5) | (((encoders_3_live_a) & 12'hfff) << 32'h6) | (((encoders_3_live_b) & 12'hfff) << 32'h7) | (((indices) & 12'hfff) << 32'h8);
    always @(*) masked_errors = errors & registers_encoder_fault_mask;

    always @(*) begin
        case (sequencer_axis)
            0:
            begin
                count = encoders_0_count;
                edge_time = encoders_0_edge_time;
                direction = encoders_0_direction;
                index_count = encoders_0_index_count;
                index_event = encoders_0_index_event;
                index_clear = clear_at_tick_q[(32'h0)+:(1)];
            end
            1:
            begin
                count = encoders_1_count;
                edge_time = encoders_1_edge_time;
                direction = encoders_1_direction;
                index_count = encoders_1_index_count;
                index_event = encoders_1_index_event;
                index_clear = clear_at_tick_q[(32'h1)+:(1)];
            end
            2:
            begin
                count = encoders_2_count;
                edge_time = encoders_2_edge_time;
                direction = encoders_2_direction;
                index_count = encoders_2_index_count;
                index_event = encoders_2_index_event;
                index_clear = clear_at_tick_q[(32'h2)+:(1)];
            end
            default:
            begin
                count = encoders_3_count;
                edge_time = encoders_3_edge_time;
                direction = encoders_3_direction;
                index_count = encoders_3_index_count;
                index_event = encoders_3_index_event;
                index_clear = clear_at_tick_q[(32'h3)+:(1)];
            end
        endcase
    end

    always @(*) begin
        case (sequencer_input_port)
            0:
            begin
                sequencer_input_data = ((count) & 32'hffffffff);
            end
            1:
            begin
                sequencer_input_data = ((edge_time) & 32'hffffffff);
            end
            2:
            begin
                sequencer_input_data = ((line_q) & 32'hffffffff);
            end
            3:
            begin
                sequencer_input_data = ((now_q) & 32'hffffffff);
            end
            4:
            begin
                sequencer_input_data = ((timebase_period) & 32'hffffffff);
            end
            5:
            begin
                sequencer_input_data = ((registers_mode[(32'h0)+:(1)]) & 32'hffffffff);
            end
            6:
            begin
                sequencer_input_data = ((registers_mode[(32'h1)+:(1)]) & 32'hffffffff);
            end
            7:
            begin
                sequencer_input_data = ((status_at_tick_q[(32'h0)+:(1)]) & 32'hffffffff);
            end
            8:
            begin
                sequencer_input_data = ((status_at_tick_q[(32'h1)+:(1)]) & 32'hffffffff);
            end
            9:
            begin
                sequencer_input_data = ((registers_pwm_period) & 32'hffffffff);
            end
            10:
            begin
                sequencer_input_data = ((status_at_tick_q) & 32'hffffffff);
            end
            11:
            begin
                sequencer_input_data = ((faults_at_tick_q) & 32'hffffffff);
            end
            12:
            begin
                sequencer_input_data = ((index_event) & 32'hffffffff);
            end
            13:
            begin
                sequencer_input_data = ((index_clear) & 32'hffffffff);
            end
            14:
            begin
                sequencer_input_data = ((index_count) & 32'hffffffff);
            end
            15:
            begin
                sequencer_input_data = ((registers_mode[(32'h2)+:(1)]) & 32'hffffffff);
            end
            16:
            begin
                sequencer_input_data = ((trigonometry_fraction) & 32'hffffffff);
            end
            17:
            begin
                sequencer_input_data = ((trigonometry_sine) & 32'hffffffff);
            end
            default:
            begin
                sequencer_input_data = ((trigonometry_cosine) & 32'hffffffff);
            end
        endcase
    end

    always @(*) trigonometry_load = sequencer_output_strobe & (sequencer_output_port == port_angle);
    always @(*) compare = sequencer_output_data[(32'hc)+:(13)];
    always @(*) alive = ~monitor_lclk_dead;

    always @(*) begin
        drives_0_load = 1'b0;
        stalls_0_load = 1'b0;
        drives_1_load = 1'b0;
        stalls_1_load = 1'b0;
        drives_2_load = 1'b0;
        stalls_2_load = 1'b0;
        drives_3_load = 1'b0;
        stalls_3_load = 1'b0;
        if (sequencer_output_strobe & (sequencer_output_port == port_compare)) begin
            case (sequencer_axis)
                0:
                begin
                    drives_0_load = 1'b1;
                    stalls_0_load = 1'b1;
                end
                1:
                begin
                    drives_1_load = 1'b1;
                    stalls_1_load = 1'b1;
                end
                2:
                begin
                    drives_2_load = 1'b1;
                    stalls_2_load = 1'b1;
                end
                default:
                begin
                    drives_3_load = 1'b1;
                    stalls_3_load = 1'b1;
                end
            endcase
        end
    end

    always @(*) begin
        drives_0_up_down = registers_mode[32'h3];
        drives_1_up_down = registers_mode[32'h3];
        drives_2_up_down = registers_mode[32'h3];
        drives_3_up_down = registers_mode[32'h3];
    end

    always @(*) begin
        drives_1_sync = 1'b0;
        drives_1_sync = second_starts_q;
    end

    always @(*) begin
        drives_2_sync = 1'b0;
        drives_2_sync = third_starts_q;
    end

    always @(*) begin
        drives_3_sync = 1'b0;
        drives_3_sync = fourth_starts_q;
    end

    always @(*) begin
        quarter = registers_pwm_period >> 32'h2;
        half = registers_pwm_period >> 32'h1;
    end

    always @(*) pwm_pins = ((drives_0_pwm) & 4'hf) | (((drives_1_pwm) & 4'hf) << 32'h1) | (((drives_2_pwm) & 4'hf) << 32'h2) | (((drives_3_pwm) & 4'hf) << 32'h3);
    always @(*) dir_pins = ((drives_0_dir) & 4'hf) | (((drives_1_dir) & 4'hf) << 32'h1) | (((drives_2_dir) & 4'hf) << 32'h2) | (((drives_3_dir) & 4'hf) << 32'h3);

    always @(*) begin
        pwm = pwm_pins;
        if (~alive) begin
            pwm = none;
        end
    end

    always @(*) begin
        dir = dir_pins;
        if (registers_mode[32'h3] & ~alive) begin
            dir = none;
        end
    end

    always @(*) shut = safety_off | ~alive;

    always @(*) begin
        enable_n = none;
        if (shut) begin
            enable_n = all;
        end
    end

    always @(*) begin
        kicker_charge_request = registers_kicker_control[32'h0];
        kicker_arm_on_ball = registers_kicker_control[32'h1];
        kicker_by_time = registers_kicker_control[32'h3];
    end

    always @(*) kicker_charge_n = ~(kicker_charge & ~shut);
    always @(*) kicker_trigger_n = ~(kicker_trigger & ~shut);
    always @(*) holds = registers_kicker_control[32'h2] & ~safety_stopped & alive;
    always @(*) kicker_discharge = shut & ~holds;
    always @(*) registers_radio = ((radio_selected) & 24'hffffff) | (((radio_accepted) & 24'hffffff) << 32'h8) | (((radio_dropped) & 24'hffffff) << 32'h10);
    always @(*) registers_imu_status = ((imu_value) & 9'h1ff) | (((imu_busy) & 9'h1ff) << 32'h8);
    always @(*) registers_commits = ((commit_accepted) & 32'hffffffff) | (((commit_rejected) & 32'hffffffff) << 32'h10);
    always @(*) kicker_status = ((kicker_state) & 8'hff) | (((kicker_on_ball) & 8'hff) << 32'h3) | (((kicker_ready) & 8'hff) << 32'h4) | (((kicker_timed_out) & 8'hff) << 32'h5) | (((kicker_dropped) & 8'hff) << 32'h6) | (((kicker_is_full) & 8'hff) << 32'h7);
endmodule

module rac4i65_core_bus (
    input wire clock,
    input wire ads_n,
    input wire blast_n,
    input wire lw_r,
    input wire [31:0] lad_in,
    output reg [31:0] lad_out,
    output reg lad_drive,
    output reg ready_n,
    output reg [13:0] address,
    output reg read,
    input wire [31:0] read_data,
    output reg write,
    output reg [31:0] write_data,
    input wire write_busy,
    output reg overrun,
    output reg claims
);

    // Constants
    localparam one_word = 14'b1;
    localparam one_held = 6'b1;
    localparam held_none = 6'b0;
    localparam held_limit = 6'b111111;
    localparam last_word = 14'b11111111111111;

    // Pins of the parts
    reg fetch_d;
    wire fetch_q;

    reg pending_d;
    wire pending_q;

    reg take_d;
    wire take_q;

    reg collect_d;
    wire collect_q;

    reg offer_d;
    wire offer_q;

    reg answer_d;
    wire answer_q;

    reg writing_d;
    wire writing_q;

    reg last_d;
    wire last_q;

    reg drive_d;
    wire drive_q;

    reg claiming_d;
    wire claiming_q;

    reg [13:0] word_d;
    wire [13:0] word_q;

    reg [5:0] held_d;
    wire [5:0] held_q;

    reg [31:0] to_host_d;
    wire [31:0] to_host_q;

    reg [31:0] from_host_d;
    wire [31:0] from_host_q;

    // Intermediate values
    reg [13:0] next_word;
    reg [5:0] next_held;
    reg expired;
    reg ends;

    // Parts
    rac4i65_core_dff_1 fetch (.d(fetch_d), .q(fetch_q), .clock(clock));
    rac4i65_core_dff_1 pending (.d(pending_d), .q(pending_q), .clock(clock));
    rac4i65_core_dff_1 take (.d(take_d), .q(take_q), .clock(clock));
    rac4i65_core_dff_1 collect (.d(collect_d), .q(collect_q), .clock(clock));
    rac4i65_core_dff_1 offer (.d(offer_d), .q(offer_q), .clock(clock));
    rac4i65_core_dff_1 answer (.d(answer_d), .q(answer_q), .clock(clock));
    rac4i65_core_dff_1 writing (.d(writing_d), .q(writing_q), .clock(clock));
    rac4i65_core_dff_1 last (.d(last_d), .q(last_q), .clock(clock));
    rac4i65_core_dff_1 drive (.d(drive_d), .q(drive_q), .clock(clock));
    rac4i65_core_dff_1 claiming (.d(claiming_d), .q(claiming_q), .clock(clock));
    rac4i65_core_dff_14 word (.d(word_d), .q(word_q), .clock(clock));
    rac4i65_core_dff_6 held (.d(held_d), .q(held_q), .clock(clock));
    rac4i65_core_dff_32 to_host (.d(to_host_d), .q(to_host_q), .clock(clock));
    rac4i65_core_dff_32 from_host (.d(from_host_d), .q(from_host_q), .clock(clock));

    always @(*) begin
        fetch_d = fetch_q;
        pending_d = pending_q;
        take_d = take_q;
        collect_d = collect_q;
        offer_d = offer_q;
        answer_d = answer_q;
        writing_d = writing_q;
        last_d = last_q;
        drive_d = drive_q;
        claiming_d = claiming_q;
        word_d = word_q;
        held_d = held_q;
        fetch_d = 1'b0;
        pending_d = fetch_q;
        take_d = pending_q;
        collect_d = 1'b0;
        offer_d = collect_q;
        claiming_d = collect_q;
        answer_d = take_q;
        last_d = (last_q | ~blast_n) & ~answer_q;
        if (fetch_q) begin
            drive_d = 1'b1;
        end
        if (offer_q) begin
            if (write_busy & ~expired) begin
                offer_d = 1'b1;
                claiming_d = 1'b1;
                held_d = next_held;
            end
            else begin
                answer_d = 1'b1;
                held_d = held_none;
            end
        end
        if (answer_q) begin
            if (ends) begin
                drive_d = 1'b0;
            end
            else begin
                word_d = next_word;
                fetch_d = ~writing_q;
                claiming_d = ~writing_q;
                collect_d = writing_q;
            end
        end
        if (~ads_n) begin
            word_d = lad_in[(32'h2)+:(14)];
            writing_d = lw_r;
            fetch_d = ~lw_r;
            claiming_d = ~lw_r;
            pending_d = 1'b0;
            take_d = 1'b0;
            collect_d = lw_r;
            offer_d = 1'b0;
            answer_d = 1'b0;
            drive_d = 1'b0;
            last_d = 1'b0;
            held_d = held_none;
        end
    end

    always @(*) begin
        to_host_d = to_host_q;
        if (take_q) begin
            to_host_d = read_data;
        end
    end

    always @(*) begin
        from_host_d = from_host_q;
        if (collect_q) begin
            from_host_d = lad_in;
        end
    end

    always @(*) begin
        next_word = word_q + one_word;
        address = word_q;
    end

    always @(*) begin
        next_held = held_q + one_held;
        expired = held_q == held_limit;
    end

    always @(*) ends = last_q | ~blast_n | (word_q == last_word);
    always @(*) lad_out = to_host_q;
    always @(*) lad_drive = drive_q;
    always @(*) ready_n = ~answer_q;
    always @(*) read = fetch_q;
    always @(*) write = offer_q & ~write_busy;
    always @(*) write_data = from_host_q;
    always @(*) claims = claiming_q;
    always @(*) overrun = offer_q & write_busy & expired;
endmodule

module rac4i65_core_registers (
    input wire clock,
    input wire [5:0] address,
    input wire write,
    input wire [31:0] data,
    output reg [31:0] written,
    output reg [31:0] read_data,
    input wire was_in_page,
    output reg [23:0] kept_data,
    input wire armed,
    input wire [31:0] board,
    input wire [31:0] clock_hz,
    input wire [31:0] clock_count,
    input wire [7:0] faults,
    input wire [7:0] first_fault,
    input wire [7:0] status,
    input wire [31:0] commits,
    input wire [3:0] encoder_error,
    input wire [11:0] encoder_lines,
    input wire [7:0] kicker_status,
    input wire [3:0] stall,
    input wire [7:0] index_status,
    input wire [1:0] interrupt_status,
    input wire [23:0] radio,
    input wire [8:0] imu_status,
    output reg [23:0] tick_period,
    output reg tick_period_written,
    output reg [3:0] mode,
    output reg [3:0] encoder_filter,
    output reg [3:0] encoder_fault_mask,
    output reg [12:0] pwm_period,
    output reg [9:0] pwm_blanking,
    output reg [23:0] watchdog_timeout,
    output reg [3:0] kicker_control,
    output reg [13:0] kicker_pulse,
    output reg [19:0] kicker_lockout,
    output reg [23:0] kicker_charge_timeout,
    output reg [5:0] clocks_per_microsecond,
    output reg [7:0] leds,
    output reg [15:0] set_point_timeout,
    output reg [15:0] stall_window,
    output reg [12:0] stall_compare,
    output reg [1:0] interrupt_enable,
    output reg [3:0] clear_stall,
    output reg [3:0] index_arm,
    output reg [3:0] index_clear,
    output reg [1:0] clear_interrupt,
    output reg select_radio,
    output reg [10:0] imu_control,
    output reg imu_access,
    output reg arm_write,
    output reg [7:0] clear_faults,
    output reg clear_kicker,
    output reg [3:0] clear_encoder_error,
    output reg commit_set_points,
    output reg commit_configuration,
    output reg fire
);

    // Constants
    localparam no_bits = 24'h0;
    localparam bits_10 = 24'h3ff;
    localparam bits_11 = 24'h7ff;
    localparam bits_13 = 24'h1fff;
    localparam bits_14 = 24'h3fff;
    localparam bits_16 = 24'hffff;
    localparam bits_20 = 24'hfffff;
    localparam bits_24 = 24'hffffff;
    localparam kicker_pulse_place = 6'b11010;
    localparam cookie = 32'h52414334;
    localparam version = 32'h20003;
    localparam blocks = 32'h1ff444;
    localparam axes = 32'h4;
    localparam fire_word = 32'h4b49434b;
    localparam zero = 32'h0;
    localparam no_axes = 4'h0;
    localparam no_faults = 8'h0;
    localparam no_causes = 2'b0;
    localparam content_hash = 32'h400af210;

    // Pins of the parts
    reg [23:0] tick_period_q_d;
    wire [23:0] tick_period_q_q;

    reg [3:0] mode_q_d;
    wire [3:0] mode_q_q;

    reg [3:0] encoder_filter_q_d;
    wire [3:0] encoder_filter_q_q;

    reg [3:0] encoder_fault_mask_q_d;
    wire [3:0] encoder_fault_mask_q_q;

    reg [12:0] pwm_period_q_d;
    wire [12:0] pwm_period_q_q;

    reg [9:0] pwm_blanking_q_d;
    wire [9:0] pwm_blanking_q_q;

    reg [23:0] watchdog_timeout_q_d;
    wire [23:0] watchdog_timeout_q_q;

    reg [3:0] kicker_control_q_d;
    wire [3:0] kicker_control_q_q;

    reg [13:0] kicker_pulse_q_d;
    wire [13:0] kicker_pulse_q_q;

    reg [19:0] kicker_lockout_q_d;
    wire [19:0] kicker_lockout_q_q;

    reg [23:0] kicker_charge_timeout_q_d;
    wire [23:0] kicker_charge_timeout_q_q;

    reg [5:0] clocks_per_microsecond_q_d;
    wire [5:0] clocks_per_microsecond_q_q;

    reg [7:0] leds_q_d;
    wire [7:0] leds_q_q;

    reg [15:0] set_point_timeout_q_d;
    wire [15:0] set_point_timeout_q_q;

    reg [15:0] stall_window_q_d;
    wire [15:0] stall_window_q_q;

    reg [12:0] stall_compare_q_d;
    wire [12:0] stall_compare_q_q;

    reg [1:0] interrupt_enable_q_d;
    wire [1:0] interrupt_enable_q_q;

    reg [3:0] index_clear_q_d;
    wire [3:0] index_clear_q_q;

    reg [10:0] imu_control_q_d;
    wire [10:0] imu_control_q_q;

    reg [31:0] read_q_d;
    wire [31:0] read_q_q;

    reg writing_d;
    wire writing_q;

    reg [5:0] place_d;
    wire [5:0] place_q;

    reg [31:0] word_d;
    wire [31:0] word_q;

    wire [23:0] kept_read_data;

    reg [23:0] kept_write_data;
    reg kept_write_enable;
    reg [23:0] mask_d;
    wire [23:0] mask_q;

    // Intermediate values
    reg unlocked;

    // Parts
    rac4i65_core_dff_24_from_8235 tick_period_q (.d(tick_period_q_d), .q(tick_period_q_q), .clock(clock));
    rac4i65_core_dff_4 mode_q (.d(mode_q_d), .q(mode_q_q), .clock(clock));
    rac4i65_core_dff_4_from_3 encoder_filter_q (.d(encoder_filter_q_d), .q(encoder_filter_q_q), .clock(clock));
    rac4i65_core_dff_4_from_f encoder_fault_mask_q(
        .d(encoder_fault_mask_q_d),
        .q(encoder_fault_mask_q_q),
        .clock(clock)
    );
    rac4i65_core_dff_13 pwm_period_q (.d(pwm_period_q_d), .q(pwm_period_q_q), .clock(clock));
    rac4i65_core_dff_10_from_21 pwm_blanking_q (.d(pwm_blanking_q_d), .q(pwm_blanking_q_q), .clock(clock));
    rac4i65_core_dff_24 watchdog_timeout_q (.d(watchdog_timeout_q_d), .q(watchdog_timeout_q_q), .clock(clock));
    rac4i65_core_dff_4 kicker_control_q (.d(kicker_control_q_d), .q(kicker_control_q_q), .clock(clock));
    rac4i65_core_dff_14 kicker_pulse_q (.d(kicker_pulse_q_d), .q(kicker_pulse_q_q), .clock(clock));
    rac4i65_core_dff_20 kicker_lockout_q (.d(kicker_lockout_q_d), .q(kicker_lockout_q_q), .clock(clock));
    rac4i65_core_dff_24_2 kicker_charge_timeout_q(
        .d(kicker_charge_timeout_q_d),
        .q(kicker_charge_timeout_q_q),
        .clock(clock)
    );
    rac4i65_core_dff_6_from_21 clocks_per_microsecond_q(
        .d(clocks_per_microsecond_q_d),
        .q(clocks_per_microsecond_q_q),
        .clock(clock)
    );
    rac4i65_core_dff_8 leds_q (.d(leds_q_d), .q(leds_q_q), .clock(clock));
    rac4i65_core_dff_16_from_1e set_point_timeout_q(
        .d(set_point_timeout_q_d),
        .q(set_point_timeout_q_q),
        .clock(clock)
    );
    rac4i65_core_dff_16_from_c8 stall_window_q (.d(stall_window_q_d), .q(stall_window_q_q), .clock(clock));
    rac4i65_core_dff_13 stall_compare_q (.d(stall_compare_q_d), .q(stall_compare_q_q), .clock(clock));
    rac4i65_core_dff_2 interrupt_enable_q (.d(interrupt_enable_q_d), .q(interrupt_enable_q_q), .clock(clock));
    rac4i65_core_dff_4 index_clear_q (.d(index_clear_q_d), .q(index_clear_q_q), .clock(clock));
    rac4i65_core_dff_11 imu_control_q (.d(imu_control_q_d), .q(imu_control_q_q), .clock(clock));
    rac4i65_core_dff_32 read_q (.d(read_q_d), .q(read_q_q), .clock(clock));
    rac4i65_core_dff_1 writing (.d(writing_d), .q(writing_q), .clock(clock));
    rac4i65_core_dff_6 place (.d(place_d), .q(place_q), .clock(clock));
    rac4i65_core_dff_32 word (.d(word_d), .q(word_q), .clock(clock));
    rac4i65_core_registers_kept kept(
        .clock(clock),
        .read_address(place_q),
        .read_data(kept_read_data),
        .write_address(place_q),
        .write_data(kept_write_data),
        .write_enable(kept_write_enable)
    );
    rac4i65_core_dff_24_2 mask (.d(mask_d), .q(mask_q), .clock(clock));

    always @(*) begin
        tick_period_q_d = tick_period_q_q;
        mode_q_d = mode_q_q;
        encoder_filter_q_d = encoder_filter_q_q;
        pwm_period_q_d = pwm_period_q_q;
        pwm_blanking_q_d = pwm_blanking_q_q;
        watchdog_timeout_q_d = watchdog_timeout_q_q;
        encoder_fault_mask_q_d = encoder_fault_mask_q_q;
        kicker_control_q_d = kicker_control_q_q;
        kicker_pulse_q_d = kicker_pulse_q_q;
        kicker_lockout_q_d = kicker_lockout_q_q;
        kicker_charge_timeout_q_d = kicker_charge_timeout_q_q;
        clocks_per_microsecond_q_d = clocks_per_microsecond_q_q;
        leds_q_d = leds_q_q;
        set_point_timeout_q_d = set_point_timeout_q_q;
        stall_window_q_d = stall_window_q_q;
        stall_compare_q_d = stall_compare_q_q;
        interrupt_enable_q_d = interrupt_enable_q_q;
        index_clear_q_d = index_clear_q_q;
        imu_control_q_d = imu_control_q_q;
        tick_period_written = 1'b0;
        arm_write = 1'b0;
        select_radio = 1'b0;
        imu_access = 1'b0;
        clear_faults = no_faults;
        clear_kicker = 1'b0;
        commit_set_points = 1'b0;
        commit_configuration = 1'b0;
        fire = 1'b0;
        clear_encoder_error = no_axes;
        clear_stall = no_axes;
        index_arm = no_axes;
        clear_interrupt = no_causes;
        if (writing_q) begin
            case (place_q)
                8:
                begin
                    if (unlocked) begin
                        tick_period_q_d = word_q[(32'h0)+:(24)];
                        tick_period_written = 1'b1;
                    end
                end
                9:
                begin
                    if (unlocked) begin
                        mode_q_d = word_q[(32'h0)+:(4)];
                    end
                end
                10:
                begin
                    if (unlocked) begin
                        encoder_filter_q_d = word_q[(32'h0)+:(4)];
                    end
                end
                11:
                begin
                    if (unlocked) begin
                        pwm_period_q_d = word_q[(32'h0)+:(13)];
                    end
                end
                12:
                begin
                    if (unlocked) begin
                        pwm_blanking_q_d = word_q[(32'h0)+:(10)];
                    end
                end
                13:
                begin
                    if (unlocked) begin
                        watchdog_timeout_q_d = word_q[(32'h0)+:(24)];
                    end
                end
                14:
                begin
                    arm_write = 1'b1;
                end
                15:
                begin
                    clear_faults = word_q[(32'h0)+:(8)];
                    clear_kicker = word_q != zero;
                end
                18:
                begin
                    commit_set_points = 1'b1;
                end
                19:
                begin
                    commit_configuration = 1'b1;
                end
                21:
                begin
                    clear_encoder_error = word_q[(32'h0)+:(4)];
                end
                23:
                begin
                    if (unlocked) begin
                        encoder_fault_mask_q_d = word_q[(32'h0)+:(4)];
                    end
                end
                24:
                begin
                    kicker_control_q_d = word_q[(32'h0)+:(4)];
                end
                25:
                begin
                    fire = word_q == fire_word;
                end
                26:
                begin
                    kicker_pulse_q_d = word_q[(32'h0)+:(14)];
                end
                27:
                begin
                    if (unlocked) begin
                        kicker_lockout_q_d = word_q[(32'h0)+:(20)];
                    end
                end
                28:
                begin
                    if (unlocked) begin
                        kicker_charge_timeout_q_d = word_q[(32'h0)+:(24)];
                    end
                end
                30:
                begin
                    if (unlocked) begin
                        clocks_per_microsecond_q_d = word_q[(32'h0)+:(6)];
                    end
                end
                31:
                begin
                    leds_q_d = word_q[(32'h0)+:(8)];
                end
                32:
                begin
                    if (unlocked) begin
                        set_point_timeout_q_d = word_q[(32'h0)+:(16)];
                    end
                end
                33:
                begin
                    if (unlocked) begin
                        stall_window_q_d = word_q[(32'h0)+:(16)];
                    end
                end
                34:
                begin
                    if (unlocked) begin
                        stall_compare_q_d = word_q[(32'h0)+:(13)];
                    end
                end
                35:
                begin
                    clear_stall = word_q[(32'h0)+:(4)];
                end
                36:
                begin
                    index_arm = word_q[(32'h0)+:(4)];
                    index_clear_q_d = (index_clear_q_q & ~word_q[(32'h0)+:(4)]) | (word_q[(32'h4)+:(4)] & word_q[(32'h0)+:(4)]);
                end
                38:
                begin
                    interrupt_enable_q_d = word_q[(32'h0)+:(2)];
                end
                39:
                begin
                    clear_interrupt = word_q[(32'h0)+:(2)];
                end
                40:
                begin
                    select_radio = 1'b1;
                end
                41:
                begin
                    if (unlocked) begin
                        imu_control_q_d = word_q[(32'h0)+:(11)];
                    end
                end
                42:
                begin
                    imu_access = 1'b1;
                end
                default:
                begin
                    fire = 1'b0;
                end
            endcase
        end
    end

    always @(*) begin
        read_q_d = read_q_q;
        read_q_d = zero;
        if (was_in_page) begin
            case (place_q)
                0:
                begin
                    read_q_d = cookie;
                end
                1:
                begin
                    read_q_d = version;
                end
                2:
                begin
                    read_q_d = board;
                end
                3:
                begin
                    read_q_d = clock_hz;
                end
                4:
                begin
                    read_q_d = content_hash;
                end
                5:
                begin
                    read_q_d = axes;
                end
                6:
                begin
                    read_q_d = clock_count;
                end
                7:
                begin
                    read_q_d = blocks;
                end
                9:
                begin
                    read_q_d = ((mode_q_q) & 32'hffffffff);
                end
                10:
                begin
                    read_q_d = ((encoder_filter_q_q) & 32'hffffffff);
                end
                15:
                begin
                    read_q_d = ((faults) & 32'hffffffff);
                end
                16:
                begin
                    read_q_d = ((first_fault) & 32'hffffffff);
                end
                17:
                begin
                    read_q_d = ((status) & 32'hffffffff);
                end
                20:
                begin
                    read_q_d = commits;
                end
                21:
                begin
                    read_q_d = ((encoder_error) & 32'hffffffff);
                end
                22:
                begin
                    read_q_d = ((encoder_lines) & 32'hffffffff);
                end
                23:
                begin
                    read_q_d = ((encoder_fault_mask_q_q) & 32'hffffffff);
                end
                24:
                begin
                    read_q_d = ((kicker_control_q_q) & 32'hffffffff);
                end
                29:
                begin
                    read_q_d = ((kicker_status) & 32'hffffffff);
                end
                30:
                begin
                    read_q_d = ((clocks_per_microsecond_q_q) & 32'hffffffff);
                end
                31:
                begin
                    read_q_d = ((leds_q_q) & 32'hffffffff);
                end
                35:
                begin
                    read_q_d = ((stall) & 32'hffffffff);
                end
                37:
                begin
                    read_q_d = ((index_status) & 32'hffffffff);
                end
                38:
                begin
                    read_q_d = ((interrupt_enable_q_q) & 32'hffffffff);
                end
                39:
                begin
                    read_q_d = ((interrupt_status) & 32'hffffffff);
                end
                40:
                begin
                    read_q_d = ((radio) & 32'hffffffff);
                end
                43:
                begin
                    read_q_d = ((imu_status) & 32'hffffffff);
                end
                default:
                begin
                    read_q_d = zero;
                end
            endcase
        end
    end

    always @(*) begin
        mask_d = mask_q;
        mask_d = no_bits;
        if (was_in_page) begin
            case (place_q)
                8:
                begin
                    mask_d = bits_24;
                end
                11:
                begin
                    mask_d = bits_13;
                end
                12:
                begin
                    mask_d = bits_10;
                end
                13:
                begin
                    mask_d = bits_24;
                end
                26:
                begin
                    mask_d = bits_14;
                end
                27:
                begin
                    mask_d = bits_20;
                end
                28:
                begin
                    mask_d = bits_24;
                end
                32:
                begin
                    mask_d = bits_16;
                end
                33:
                begin
                    mask_d = bits_16;
                end
                34:
                begin
                    mask_d = bits_13;
                end
                41:
                begin
                    mask_d = bits_11;
                end
                default:
                begin
                    mask_d = no_bits;
                end
            endcase
        end
    end

    always @(*) begin
        writing_d = writing_q;
        writing_d = write;
    end

    always @(*) begin
        place_d = place_q;
        place_d = address;
    end

    always @(*) begin
        word_d = word_q;
        word_d = data;
    end

    always @(*) unlocked = ~armed;

    always @(*) begin
        written = word_q;
        kept_write_data = word_q[(32'h0)+:(24)];
    end

    always @(*) kept_write_enable = writing_q & (unlocked | (place_q == kicker_pulse_place));
    always @(*) kept_data = kept_read_data & mask_q;
    always @(*) read_data = read_q_q;
    always @(*) tick_period = tick_period_q_q;
    always @(*) mode = mode_q_q;
    always @(*) encoder_filter = encoder_filter_q_q;
    always @(*) pwm_period = pwm_period_q_q;
    always @(*) pwm_blanking = pwm_blanking_q_q;
    always @(*) watchdog_timeout = watchdog_timeout_q_q;
    always @(*) encoder_fault_mask = encoder_fault_mask_q_q;
    always @(*) kicker_control = kicker_control_q_q;
    always @(*) kicker_pulse = kicker_pulse_q_q;
    always @(*) kicker_lockout = kicker_lockout_q_q;
    always @(*) kicker_charge_timeout = kicker_charge_timeout_q_q;
    always @(*) clocks_per_microsecond = clocks_per_microsecond_q_q;
    always @(*) leds = leds_q_q;
    always @(*) set_point_timeout = set_point_timeout_q_q;
    always @(*) stall_window = stall_window_q_q;
    always @(*) stall_compare = stall_compare_q_q;
    always @(*) interrupt_enable = interrupt_enable_q_q;
    always @(*) index_clear = index_clear_q_q;
    always @(*) imu_control = imu_control_q_q;
endmodule

module rac4i65_core_registers_kept (
    input wire clock,
    input wire [5:0] read_address,
    output reg [23:0] read_data,
    input wire [5:0] write_address,
    input wire [23:0] write_data,
    input wire write_enable
);

    (* no_rw_check *)
    reg [23:0] mem [0:63];

    initial begin
        read_data = 24'h0;
        mem[0] = 24'h0;
        mem[1] = 24'h0;
        mem[2] = 24'h0;
        mem[3] = 24'h0;
        mem[4] = 24'h0;
        mem[5] = 24'h0;
        mem[6] = 24'h0;
        mem[7] = 24'h0;
        mem[8] = 24'h8235;
        mem[9] = 24'h0;
        mem[10] = 24'h0;
        mem[11] = 24'h0;
        mem[12] = 24'h21;
        mem[13] = 24'h196e6b;
        mem[14] = 24'h0;
        mem[15] = 24'h0;
        mem[16] = 24'h0;
        mem[17] = 24'h0;
        mem[18] = 24'h0;
        mem[19] = 24'h0;
        mem[20] = 24'h0;
        mem[21] = 24'h0;
        mem[22] = 24'h0;
        mem[23] = 24'h0;
        mem[24] = 24'h0;
        mem[25] = 24'h0;
        mem[26] = 24'h0;
        mem[27] = 24'h0;
        mem[28] = 24'h0;
        mem[29] = 24'h0;
        mem[30] = 24'h0;
        mem[31] = 24'h0;
        mem[32] = 24'h1e;
        mem[33] = 24'hc8;
        mem[34] = 24'h0;
        mem[35] = 24'h0;
        mem[36] = 24'h0;
        mem[37] = 24'h0;
        mem[38] = 24'h0;
        mem[39] = 24'h0;
        mem[40] = 24'h0;
        mem[41] = 24'h0;
        mem[42] = 24'h0;
        mem[43] = 24'h0;
        mem[44] = 24'h0;
        mem[45] = 24'h0;
        mem[46] = 24'h0;
        mem[47] = 24'h0;
        mem[48] = 24'h0;
        mem[49] = 24'h0;
        mem[50] = 24'h0;
        mem[51] = 24'h0;
        mem[52] = 24'h0;
        mem[53] = 24'h0;
        mem[54] = 24'h0;
        mem[55] = 24'h0;
        mem[56] = 24'h0;
        mem[57] = 24'h0;
        mem[58] = 24'h0;
        mem[59] = 24'h0;
        mem[60] = 24'h0;
        mem[61] = 24'h0;
        mem[62] = 24'h0;
        mem[63] = 24'h0;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
        if (write_enable) mem[write_address] <= write_data;
    end
endmodule

module rac4i65_core_timebase (
    input wire clock,
    input wire [23:0] tick_period,
    input wire restart,
    input wire [5:0] clocks_per_microsecond,
    input wire [15:0] stall_window,
    output reg [31:0] clock_count,
    output reg [23:0] period,
    output reg tick,
    output reg microsecond,
    output reg window
);

    // Constants
    localparam one = 32'h1;
    localparam one_phase = 24'h1;
    localparam one_part = 6'b1;
    localparam one_tick = 16'h1;
    localparam shortest = 24'h3e8;
    localparam shortest_part = 6'b11001;
    localparam longest_part = 6'b100010;

    // Pins of the parts
    reg [31:0] clocks_d;
    wire [31:0] clocks_q;

    reg [23:0] limit_d;
    wire [23:0] limit_q;

    reg [23:0] phase_d;
    wire [23:0] phase_q;

    reg [5:0] part_limit_d;
    wire [5:0] part_limit_q;

    reg [5:0] part_d;
    wire [5:0] part_q;

    reg [15:0] ticks_d;
    wire [15:0] ticks_q;

    reg ticking_d;
    wire ticking_q;

    reg window_ends_d;
    wire window_ends_q;

    reg microsecond_ends_d;
    wire microsecond_ends_q;

    // Intermediate values
    reg tick_now;

    // Parts
    rac4i65_core_dff_32 clocks (.d(clocks_d), .q(clocks_q), .clock(clock));
    rac4i65_core_dff_24_from_8235 limit (.d(limit_d), .q(limit_q), .clock(clock));
    rac4i65_core_dff_24_from_1 phase (.d(phase_d), .q(phase_q), .clock(clock));
    rac4i65_core_dff_6_from_21 part_limit (.d(part_limit_d), .q(part_limit_q), .clock(clock));
    rac4i65_core_dff_6_from_1 part (.d(part_d), .q(part_q), .clock(clock));
    rac4i65_core_dff_16_from_1 ticks (.d(ticks_d), .q(ticks_q), .clock(clock));
    rac4i65_core_dff_1 ticking (.d(ticking_d), .q(ticking_q), .clock(clock));
    rac4i65_core_dff_1 window_ends (.d(window_ends_d), .q(window_ends_q), .clock(clock));
    rac4i65_core_dff_1 microsecond_ends (.d(microsecond_ends_d), .q(microsecond_ends_q), .clock(clock));

    always @(*) begin
        clocks_d = clocks_q;
        clocks_d = clocks_q + one;
    end

    always @(*) begin
        limit_d = limit_q;
        limit_d = tick_period;
        if (tick_period < shortest) begin
            limit_d = shortest;
        end
    end

    always @(*) begin
        phase_d = phase_q;
        phase_d = phase_q + one_phase;
        tick_now = 1'b0;
        if (restart) begin
            phase_d = one_phase;
        end
        else if (phase_q >= limit_q) begin
            phase_d = one_phase;
            tick_now = 1'b1;
        end
    end

    always @(*) begin
        part_limit_d = part_limit_q;
        part_limit_d = clocks_per_microsecond;
        if (clocks_per_microsecond < shortest_part) begin
            part_limit_d = shortest_part;
        end
        if (clocks_per_microsecond > longest_part) begin
            part_limit_d = longest_part;
        end
    end

    always @(*) begin
        part_d = part_q;
        microsecond_ends_d = microsecond_ends_q;
        part_d = part_q + one_part;
        microsecond_ends_d = 1'b0;
        if (part_q >= part_limit_q) begin
            part_d = one_part;
            microsecond_ends_d = 1'b1;
        end
    end

    always @(*) begin
        ticks_d = ticks_q;
        if (ticking_q) begin
            ticks_d = ticks_q + one_tick;
            if (window_ends_q) begin
                ticks_d = one_tick;
            end
        end
    end

    always @(*) begin
        ticking_d = ticking_q;
        ticking_d = tick_now;
    end

    always @(*) begin
        window_ends_d = window_ends_q;
        window_ends_d = tick_now & (ticks_q >= stall_window);
    end

    always @(*) clock_count = clocks_q;
    always @(*) period = limit_q;
    always @(*) tick = ticking_q;
    always @(*) window = window_ends_q;
    always @(*) microsecond = microsecond_ends_q;
endmodule

module rac4i65_core_decoder (
    input wire clock,
    input wire [13:0] address,
    input wire read,
    input wire configuration_bank,
    input wire set_point_bank,
    input wire [1:0] snapshot_bank,
    output reg at_registers,
    output reg in_registers,
    output reg in_memory,
    output reg in_imu,
    output reg [7:0] memory_address,
    output reg [7:0] staging_address,
    output reg stages_set_point,
    output reg stages_configuration,
    output reg [5:0] word,
    output reg [13:0] staging_word,
    output reg snapshot_first,
    output reg snapshot_last
);

    // Constants
    localparam no_bank = 8'h0;
    localparam configuration_1 = 8'h40;
    localparam at_set_points = 8'h80;
    localparam set_points_1 = 8'h8;
    localparam page_registers = 8'h0;
    localparam page_configuration = 8'h4;
    localparam page_active = 8'h5;
    localparam page_set_points = 8'h6;
    localparam page_state = 8'h7;
    localparam page_snapshot = 8'h8;
    localparam at_page_configuration = 14'b100000000;
    localparam at_page_set_points = 14'b110000000;
    localparam configuration_end = 6'b110100;
    localparam set_points_end = 6'b100;
    localparam active_start = 6'b10000;
    localparam active_end = 6'b10100;
    localparam index_start = 6'b11100;
    localparam index_end = 6'b100000;
    localparam integrals_start = 6'b100100;
    localparam integrals_end = 6'b101000;
    localparam snapshot_end = 6'b11000;
    localparam first = 6'b0;
    localparam imu_row = 3'b11;
    localparam last = 6'b10111;

    // Pins of the parts
    reg registers_d;
    wire registers_q;

    reg configuration_d;
    wire configuration_q;

    reg active_d;
    wire active_q;

    reg set_points_d;
    wire set_points_q;

    reg state_d;
    wire state_q;

    reg snapshot_d;
    wire snapshot_q;

    reg [5:0] offset_d;
    wire [5:0] offset_q;

    reg reads_first_d;
    wire reads_first_q;

    reg reads_last_d;
    wire reads_last_q;

    reg [4:0] place_word;

    wire [7:0] place_address;

    // Intermediate values
    reg [7:0] page;
    reg [5:0] coming;
    reg [5:0] index;
    reg [7:0] wide;
    reg [7:0] set_point;
    reg [7:0] staged_set_point;
    reg [7:0] staged_configuration;
    reg [7:0] base;
    reg [7:0] bank;

    // Parts
    rac4i65_core_dff_1 registers (.d(registers_d), .q(registers_q), .clock(clock));
    rac4i65_core_dff_1 configuration (.d(configuration_d), .q(configuration_q), .clock(clock));
    rac4i65_core_dff_1 active (.d(active_d), .q(active_q), .clock(clock));
    rac4i65_core_dff_1 set_points (.d(set_points_d), .q(set_points_q), .clock(clock));
    rac4i65_core_dff_1 state (.d(state_d), .q(state_q), .clock(clock));
    rac4i65_core_dff_1 snapshot (.d(snapshot_d), .q(snapshot_q), .clock(clock));
    rac4i65_core_dff_6 offset (.d(offset_d), .q(offset_q), .clock(clock));
    rac4i65_core_dff_1 reads_first (.d(reads_first_d), .q(reads_first_q), .clock(clock));
    rac4i65_core_dff_1 reads_last (.d(reads_last_d), .q(reads_last_q), .clock(clock));
    rac4i65_core_place place (.word(place_word), .bank(snapshot_bank), .address(place_address));

    always @(*) begin
        registers_d = registers_q;
        registers_d = page == page_registers;
    end

    always @(*) begin
        configuration_d = configuration_q;
        configuration_d = page == page_configuration;
    end

    always @(*) begin
        active_d = active_q;
        active_d = page == page_active;
    end

    always @(*) begin
        set_points_d = set_points_q;
        set_points_d = page == page_set_points;
    end

    always @(*) begin
        state_d = state_q;
        state_d = page == page_state;
    end

    always @(*) begin
        snapshot_d = snapshot_q;
        snapshot_d = page == page_snapshot;
    end

    always @(*) begin
        offset_d = offset_q;
        offset_d = coming;
    end

    always @(*) begin
        reads_first_d = reads_first_q;
        reads_first_d = read & (page == page_snapshot) & (coming == first);
    end

    always @(*) begin
        reads_last_d = reads_last_q;
        reads_last_d = read & (page == page_snapshot) & (coming == last);
    end

    always @(*) begin
        page = address[(32'h6)+:(8)];
        coming = address[(32'h0)+:(6)];
    end

    always @(*) at_registers = page == page_registers;
    always @(*) index = offset_q;

    always @(*) begin
        word = index;
        wide = ((index) & 8'hff);
        place_word = index[(32'h0)+:(5)];
        set_point = ((index[(32'h0)+:(2)]) & 8'hff) | at_set_points;
    end

    always @(*) in_registers = registers_q;

    always @(*) begin
        in_memory = 1'b0;
        in_imu = 1'b0;
        stages_set_point = 1'b0;
        stages_configuration = 1'b0;
        bank = no_bank;
        base = wide;
        if (configuration_q) begin
            in_memory = index < configuration_end;
            stages_configuration = index < configuration_end;
            if (~configuration_bank) begin
                bank = configuration_1;
            end
        end
        if (active_q) begin
            in_memory = index < configuration_end;
            if (configuration_bank) begin
                bank = configuration_1;
            end
        end
        if (set_points_q) begin
            base = set_point;
            if (index < set_points_end) begin
                in_memory = 1'b1;
                stages_set_point = 1'b1;
                if (~set_point_bank) begin
                    bank = set_points_1;
                end
            end
            else begin
                in_memory = (index >= active_start) & (index < active_end);
                if (set_point_bank) begin
                    bank = set_points_1;
                end
            end
        end
        if (state_q) begin
            in_memory = ((index >= integrals_start) & (index < integrals_end)) | ((index >= index_start) & (index < index_end));
            base = wide | at_set_points;
        end
        if (snapshot_q) begin
            in_memory = index < snapshot_end;
            in_imu = index[(32'h3)+:(3)] == imu_row;
            base = place_address;
        end
    end

    always @(*) snapshot_first = reads_first_q;
    always @(*) snapshot_last = reads_last_q;
    always @(*) memory_address = base | bank;

    always @(*) begin
        staged_set_point = set_point;
        if (~set_point_bank) begin
            staged_set_point = set_point | set_points_1;
        end
    end

    always @(*) begin
        staged_configuration = wide;
        if (~configuration_bank) begin
            staged_configuration = wide | configuration_1;
        end
    end

    always @(*) begin
        staging_address = staged_configuration;
        staging_word = ((index) & 14'h3fff) | at_page_configuration;
        if (set_points_q) begin
            staging_address = staged_set_point;
            staging_word = ((index) & 14'h3fff) | at_page_set_points;
        end
    end
endmodule

module rac4i65_core_place (
    input wire [4:0] word,
    input wire [1:0] bank,
    output reg [7:0] address
);

    // Constants
    localparam at_first = 8'hc0;
    localparam at_second = 8'he0;
    localparam at_third = 8'hd8;
    localparam at_third_middle = 8'hf8;
    localparam at_third_end = 8'h78;

    // Intermediate values
    reg [7:0] wide;
    reg [7:0] row;

    always @(*) begin
        wide = ((word) & 8'hff);
        row = ((word[(32'h0)+:(3)]) & 8'hff);
    end

    always @(*) begin
        address = wide | at_first;
        if (bank[32'h0]) begin
            address = wide | at_second;
        end
        if (bank[32'h1]) begin
            address = row | at_third;
            if (word[32'h3]) begin
                address = row | at_third_middle;
            end
            if (word[32'h4]) begin
                address = row | at_third_end;
            end
        end
    end
endmodule

module rac4i65_core_commit (
    input wire clock,
    input wire stage_set_point,
    input wire stage_configuration,
    input wire commit_set_points,
    input wire commit_configuration,
    input wire [13:0] address,
    input wire [31:0] data,
    input wire [31:0] checksum,
    input wire tick,
    output reg set_point_bank,
    output reg configuration_bank,
    output reg set_points_pending,
    output reg configuration_pending,
    output reg pet,
    output reg fault,
    output reg [15:0] accepted,
    output reg [15:0] rejected
);

    // Constants
    localparam seed = 32'h52414353;
    localparam none = 6'b0;
    localparam one = 6'b1;
    localparam full = 6'b111111;
    localparam all_set_points = 6'b100;
    localparam all_configuration = 6'b110100;
    localparam one_count = 16'h1;

    // Pins of the parts
    reg [31:0] sum_d;
    wire [31:0] sum_q;

    reg sum_right_d;
    wire sum_right_q;

    reg set_points_come_d;
    wire set_points_come_q;

    reg configuration_comes_d;
    wire configuration_comes_q;

    reg [5:0] set_points_d;
    wire [5:0] set_points_q;

    reg [5:0] configuration_d;
    wire [5:0] configuration_q;

    reg set_point_bank_now_d;
    wire set_point_bank_now_q;

    reg configuration_bank_now_d;
    wire configuration_bank_now_q;

    reg set_points_wait_d;
    wire set_points_wait_q;

    reg configuration_waits_d;
    wire configuration_waits_q;

    reg [15:0] accepted_count_d;
    wire [15:0] accepted_count_q;

    reg [15:0] rejected_count_d;
    wire [15:0] rejected_count_q;

    // Intermediate values
    reg [31:0] next_sum;
    reg right;
    reg committing;

    // Parts
    rac4i65_core_dff_32_from_52414353 sum (.d(sum_d), .q(sum_q), .clock(clock));
    rac4i65_core_dff_1 sum_right (.d(sum_right_d), .q(sum_right_q), .clock(clock));
    rac4i65_core_dff_1 set_points_come (.d(set_points_come_d), .q(set_points_come_q), .clock(clock));
    rac4i65_core_dff_1 configuration_comes (.d(configuration_comes_d), .q(configuration_comes_q), .clock(clock));
    rac4i65_core_dff_6 set_points (.d(set_points_d), .q(set_points_q), .clock(clock));
    rac4i65_core_dff_6 configuration (.d(configuration_d), .q(configuration_q), .clock(clock));
    rac4i65_core_dff_1 set_point_bank_now (.d(set_point_bank_now_d), .q(set_point_bank_now_q), .clock(clock));
    rac4i65_core_dff_1 configuration_bank_now(
        .d(configuration_bank_now_d),
        .q(configuration_bank_now_q),
        .clock(clock)
    );
    rac4i65_core_dff_1 set_points_wait (.d(set_points_wait_d), .q(set_points_wait_q), .clock(clock));
    rac4i65_core_dff_1 configuration_waits (.d(configuration_waits_d), .q(configuration_waits_q), .clock(clock));
    rac4i65_core_dff_16 accepted_count (.d(accepted_count_d), .q(accepted_count_q), .clock(clock));
    rac4i65_core_dff_16 rejected_count (.d(rejected_count_d), .q(rejected_count_q), .clock(clock));

    always @(*) begin
        sum_d = sum_q;
        set_points_d = set_points_q;
        configuration_d = configuration_q;
        set_point_bank_now_d = set_point_bank_now_q;
        configuration_bank_now_d = configuration_bank_now_q;
        set_points_wait_d = set_points_wait_q;
        configuration_waits_d = configuration_waits_q;
        accepted_count_d = accepted_count_q;
        rejected_count_d = rejected_count_q;
        if (tick) begin
            if (set_points_wait_q & ~stage_set_point) begin
                set_point_bank_now_d = ~set_point_bank_now_q;
                set_points_wait_d = 1'b0;
            end
            if (configuration_waits_q & ~stage_configuration) begin
                configuration_bank_now_d = ~configuration_bank_now_q;
                configuration_waits_d = 1'b0;
            end
        end
        if (committing) begin
            sum_d = seed;
            set_points_d = none;
            configuration_d = none;
            if (right) begin
                accepted_count_d = accepted_count_q + one_count;
                if (set_points_come_q) begin
                    set_points_wait_d = 1'b1;
                end
                else begin
                    configuration_waits_d = 1'b1;
                end
            end
            else begin
                rejected_count_d = rejected_count_q + one_count;
            end
        end
        if (stage_set_point) begin
            sum_d = next_sum;
            if (set_points_q != full) begin
                set_points_d = set_points_q + one;
            end
            set_points_wait_d = 1'b0;
        end
        if (stage_configuration) begin
            sum_d = next_sum;
            if (configuration_q != full) begin
                configuration_d = configuration_q + one;
            end
            configuration_waits_d = 1'b0;
        end
    end

    always @(*) begin
        sum_right_d = sum_right_q;
        sum_right_d = checksum == sum_q;
    end

    always @(*) begin
        set_points_come_d = set_points_come_q;
        set_points_come_d = commit_set_points;
    end

    always @(*) begin
        configuration_comes_d = configuration_comes_q;
        configuration_comes_d = commit_configuration;
    end

    always @(*) next_sum = ((sum_q << 32'h1) | (sum_q >> 32'h1f)) ^ data ^ ((address) & 32'hffffffff);
    always @(*) committing = set_points_come_q | configuration_comes_q;

    always @(*) begin
        right = 1'b0;
        if (set_points_come_q) begin
            right = sum_right_q & (set_points_q == all_set_points) & (configuration_q == none);
        end
        if (configuration_comes_q) begin
            right = sum_right_q & (configuration_q == all_configuration) & (set_points_q == none);
        end
    end

    always @(*) pet = set_points_come_q & right;
    always @(*) fault = committing & ~right;
    always @(*) set_point_bank = set_point_bank_now_q;
    always @(*) configuration_bank = configuration_bank_now_q;
    always @(*) set_points_pending = set_points_wait_q;
    always @(*) configuration_pending = configuration_waits_q;
    always @(*) accepted = accepted_count_q;
    always @(*) rejected = rejected_count_q;
endmodule

module rac4i65_core_snapshot (
    input wire clock,
    input wire tick,
    input wire done,
    input wire read_first,
    input wire read_last,
    output reg [1:0] write_bank,
    output reg [1:0] read_bank
);

    // Constants
    localparam first_bank = 2'b0;
    localparam second_bank = 2'b1;

    // Pins of the parts
    reg [1:0] writing_d;
    wire [1:0] writing_q;

    reg [1:0] latest_d;
    wire [1:0] latest_q;

    reg held_d;
    wire held_q;

    reg [1:0] held_bank_d;
    wire [1:0] held_bank_q;

    // Intermediate values
    reg [1:0] kept;
    reg [1:0] target;

    // Parts
    rac4i65_core_dff_2 writing (.d(writing_d), .q(writing_q), .clock(clock));
    rac4i65_core_dff_2 latest (.d(latest_d), .q(latest_q), .clock(clock));
    rac4i65_core_dff_1 held (.d(held_d), .q(held_q), .clock(clock));
    rac4i65_core_dff_2 held_bank (.d(held_bank_d), .q(held_bank_q), .clock(clock));

    always @(*) begin
        writing_d = writing_q;
        if (tick) begin
            writing_d = target;
        end
    end

    always @(*) begin
        latest_d = latest_q;
        if (done) begin
            latest_d = writing_q;
        end
    end

    always @(*) begin
        held_d = held_q;
        held_bank_d = held_bank_q;
        read_bank = held_bank_q;
        if (read_first) begin
            held_d = 1'b1;
            held_bank_d = latest_q;
            read_bank = latest_q;
        end
        if (read_last) begin
            held_d = 1'b0;
        end
    end

    always @(*) begin
        kept = latest_q;
        if (held_q) begin
            kept = held_bank_q;
        end
    end

    always @(*) begin
        target = ~(latest_q ^ kept);
        if (latest_q == kept) begin
            target = first_bank;
            if (latest_q == first_bank) begin
                target = second_bank;
            end
        end
    end

    always @(*) write_bank = writing_q;
endmodule

module rac4i65_core_safety (
    input wire clock,
    input wire emergency_stop,
    input wire arm_write,
    input wire [31:0] arm_data,
    input wire pet,
    input wire [23:0] watchdog_timeout,
    input wire encoder_fault,
    input wire stall_fault,
    input wire commit_fault,
    input wire external_fault,
    input wire [7:0] clear_faults,
    input wire tick,
    input wire [15:0] set_point_timeout,
    output reg armed,
    output reg stops,
    output reg off,
    output reg setpoints_valid,
    output reg [7:0] faults,
    output reg [7:0] first_fault,
    output reg stopped
);

    // Constants
    localparam none = 8'h0;
    localparam watchdog_bit = 8'h1;
    localparam stop_bit = 8'h2;
    localparam encoder_bit = 8'h4;
    localparam commit_bit = 8'h8;
    localparam external_bit = 8'h10;
    localparam refused_bit = 8'h20;
    localparam stall_bit = 8'h40;
    localparam arm_1 = 32'h41524d31;
    localparam arm_2 = 32'h41524d32;
    localparam stop_filter = 4'hf;
    localparam one = 24'h1;
    localparam no_ticks = 16'h0;
    localparam one_tick = 16'h1;

    // Pins of the parts

    reg released_pin;
    reg released_tick;
    reg [3:0] released_limit;
    reg released_load;
    wire released_synchronised;
    wire released_value;
    reg [23:0] remaining_d;
    wire [23:0] remaining_q;

    reg shortened_d;
    wire shortened_q;

    reg [15:0] age_d;
    wire [15:0] age_q;

    reg first_word_d;
    wire first_word_q;

    reg is_armed_d;
    wire is_armed_q;

    reg is_off_d;
    wire is_off_q;

    reg has_setpoint_d;
    wire has_setpoint_q;

    reg [7:0] sticky_d;
    wire [7:0] sticky_q;

    reg [7:0] first_d;
    wire [7:0] first_q;

    // Intermediate values
    reg stale;
    reg is_stopped;
    reg bitten;
    reg standing;
    reg is_first_word;
    reg is_second_word;
    reg arms;
    reg stays_armed;
    reg [7:0] event_watchdog;
    reg [7:0] event_stop;
    reg [7:0] event_encoder;
    reg [7:0] event_commit;
    reg [7:0] event_external;
    reg [7:0] event_refused;
    reg [7:0] event_stall;
    reg [7:0] events;
    reg [7:0] first_kept;

    // Parts
    rac4i65_core_encoders_line_a released(
        .clock(clock),
        .pin(released_pin),
        .tick(released_tick),
        .limit(released_limit),
        .load(released_load),
        .synchronised(released_synchronised),
        .value(released_value)
    );
    rac4i65_core_dff_24_2 remaining (.d(remaining_d), .q(remaining_q), .clock(clock));
    rac4i65_core_dff_1 shortened (.d(shortened_d), .q(shortened_q), .clock(clock));
    rac4i65_core_dff_16 age (.d(age_d), .q(age_q), .clock(clock));
    rac4i65_core_dff_1 first_word (.d(first_word_d), .q(first_word_q), .clock(clock));
    rac4i65_core_dff_1 is_armed (.d(is_armed_d), .q(is_armed_q), .clock(clock));
    rac4i65_core_dff_1_from_1 is_off (.d(is_off_d), .q(is_off_q), .clock(clock));
    rac4i65_core_dff_1 has_setpoint (.d(has_setpoint_d), .q(has_setpoint_q), .clock(clock));
    rac4i65_core_dff_8 sticky (.d(sticky_d), .q(sticky_q), .clock(clock));
    rac4i65_core_dff_8 first (.d(first_d), .q(first_q), .clock(clock));

    always @(*) begin
        remaining_d = remaining_q;
        released_tick = 1'b1;
        released_limit = stop_filter;
        released_load = 1'b0;
        if (~bitten) begin
            remaining_d = remaining_q - one;
        end
        if (pet | shortened_q) begin
            remaining_d = watchdog_timeout;
        end
    end

    always @(*) begin
        shortened_d = shortened_q;
        shortened_d = remaining_q > watchdog_timeout;
    end

    always @(*) begin
        age_d = age_q;
        if (tick & ~stale) begin
            age_d = age_q + one_tick;
        end
        if (pet) begin
            age_d = no_ticks;
        end
    end

    always @(*) begin
        first_word_d = first_word_q;
        stays_armed = is_armed_q & ~standing;
        if (arm_write) begin
            first_word_d = is_first_word;
            stays_armed = arms;
        end
        if (standing) begin
            first_word_d = 1'b0;
        end
    end

    always @(*) begin
        is_armed_d = is_armed_q;
        is_armed_d = stays_armed;
    end

    always @(*) begin
        has_setpoint_d = has_setpoint_q;
        has_setpoint_d = stays_armed & ((has_setpoint_q & ~stale) | (is_armed_q & pet));
    end

    always @(*) begin
        sticky_d = sticky_q;
        sticky_d = (sticky_q & ~clear_faults) | events;
    end

    always @(*) begin
        first_d = first_q;
        first_d = first_kept;
        if (~|first_kept) begin
            first_d = events;
        end
    end

    always @(*) released_pin = ~emergency_stop;
    always @(*) is_stopped = ~released_value;
    always @(*) stopped = is_stopped;
    always @(*) bitten = ~|remaining_q;
    always @(*) stale = age_q >= set_point_timeout;
    always @(*) standing = bitten | is_stopped | encoder_fault | stall_fault | external_fault | shortened_q;
    always @(*) is_first_word = arm_data == arm_1;
    always @(*) is_second_word = arm_write & (arm_data == arm_2);
    always @(*) arms = is_second_word & first_word_q & ~standing;

    always @(*) begin
        is_off_d = (~stays_armed);
        stops = ~stays_armed;
    end

    always @(*) begin
        event_watchdog = none;
        if (bitten) begin
            event_watchdog = watchdog_bit;
        end
    end

    always @(*) begin
        event_stop = none;
        if (is_stopped) begin
            event_stop = stop_bit;
        end
    end

    always @(*) begin
        event_encoder = none;
        if (encoder_fault) begin
            event_encoder = encoder_bit;
        end
    end

    always @(*) begin
        event_commit = none;
        if (commit_fault) begin
            event_commit = commit_bit;
        end
    end

    always @(*) begin
        event_external = none;
        if (external_fault) begin
            event_external = external_bit;
        end
    end

    always @(*) begin
        event_refused = none;
        if (is_second_word & ~arms) begin
            event_refused = refused_bit;
        end
    end

    always @(*) begin
        event_stall = none;
        if (stall_fault) begin
            event_stall = stall_bit;
        end
    end

    always @(*) events = event_watchdog | event_stop | event_encoder | event_commit | event_external | event_refused | event_stall;
    always @(*) first_kept = first_q & ~clear_faults;
    always @(*) armed = is_armed_q;
    always @(*) off = |is_off_q;
    always @(*) setpoints_valid = has_setpoint_q;
    always @(*) faults = sticky_q;
    always @(*) first_fault = first_q;
endmodule

module rac4i65_core_encoders_line_a (
    input wire clock,
    input wire pin,
    input wire tick,
    input wire [3:0] limit,
    input wire load,
    output reg synchronised,
    output reg value
);

    // Constants
    localparam zero = 4'h0;
    localparam one = 4'h1;

    // Pins of the parts
    reg first_d;
    wire first_q;

    reg second_d;
    wire second_q;

    reg [3:0] run_d;
    wire [3:0] run_q;

    reg filtered_d;
    wire filtered_q;

    // Intermediate values
    reg differs;

    // Parts
    rac4i65_core_dff_1 first (.d(first_d), .q(first_q), .clock(clock));
    rac4i65_core_dff_1 second (.d(second_d), .q(second_q), .clock(clock));
    rac4i65_core_dff_4 run (.d(run_d), .q(run_q), .clock(clock));
    rac4i65_core_dff_1 filtered (.d(filtered_d), .q(filtered_q), .clock(clock));

    always @(*) begin
        first_d = first_q;
        first_d = pin;
    end

    always @(*) begin
        second_d = second_q;
        second_d = first_q;
    end

    always @(*) begin
        run_d = run_q;
        filtered_d = filtered_q;
        if (differs & tick) begin
            run_d = run_q + one;
            if (run_q >= limit) begin
                run_d = zero;
                filtered_d = second_q;
            end
        end
        if (~differs) begin
            run_d = zero;
        end
        if (load) begin
            run_d = zero;
            filtered_d = second_q;
        end
    end

    always @(*) differs = second_q ^ filtered_q;
    always @(*) synchronised = second_q;
    always @(*) value = filtered_q;
endmodule

module rac4i65_core_kicker (
    input wire clock,
    input wire enable,
    input wire microsecond,
    input wire charge_request,
    input wire [23:0] charge_timeout,
    input wire fire,
    input wire [13:0] pulse,
    input wire [19:0] lockout,
    input wire ball,
    input wire arm_on_ball,
    input wire clear,
    input wire full,
    input wire by_time,
    output reg charge,
    output reg trigger,
    output reg ready,
    output reg [2:0] state,
    output reg timed_out,
    output reg dropped,
    output reg is_full,
    output reg on_ball
);

    // Constants
    localparam off_state = 3'b0;
    localparam ready_state = 3'b1;
    localparam pending_state = 3'b10;
    localparam pulse_state = 3'b11;
    localparam commutation_state = 3'b100;
    localparam lockout_state = 3'b101;
    localparam maximum_pulse = 14'b10011100010000;
    localparam commutation_time = 20'h4e20;
    localparam minimum_lockout = 20'h186a0;
    localparam charge_gap = 10'b1111101000;
    localparam ball_limit = 4'h7;
    localparam one = 20'h1;
    localparam gap_one = 10'b1;
    localparam charged_zero = 24'h0;
    localparam charged_one = 24'h1;

    // Pins of the parts

    reg [3:0] ball_filter_limit;
    reg ball_filter_load;
    wire ball_filter_synchronised;
    wire ball_filter_value;

    reg hungry_filter_pin;

    reg [3:0] hungry_filter_limit;
    reg hungry_filter_load;
    wire hungry_filter_synchronised;
    wire hungry_filter_value;
    reg [2:0] now_d;
    wire [2:0] now_q;

    reg [19:0] coming_d;
    wire [19:0] coming_q;

    reg [9:0] gap_d;
    wire [9:0] gap_q;

    reg [23:0] charged_d;
    wire [23:0] charged_q;

    reg spent_d;
    wire spent_q;

    reg charge_pin_d;
    wire charge_pin_q;

    reg trigger_pin_d;
    wire trigger_pin_q;

    reg is_ready_d;
    wire is_ready_q;

    reg timed_out_flag_d;
    wire timed_out_flag_q;

    reg dropped_flag_d;
    wire dropped_flag_q;

    // Intermediate values
    reg stuffed;
    reg in_ready;
    reg in_pending;
    reg in_pulse;
    reg has_pulse;
    reg takes;
    reg by_ball;
    reg accepts;
    reg cancels;
    reg [2:0] idle;
    reg [2:0] next_state;
    reg [19:0] after;
    reg [13:0] short_coming;
    reg pulse_over;
    reg lockout_over;
    reg gap_over;
    reg expired;
    reg may_charge;
    reg clears_time_out;

    // Parts
    rac4i65_core_encoders_line_a ball_filter(
        .clock(clock),
        .pin(ball),
        .tick(microsecond),
        .limit(ball_filter_limit),
        .load(ball_filter_load),
        .synchronised(ball_filter_synchronised),
        .value(ball_filter_value)
    );
    rac4i65_core_encoders_line_a hungry_filter(
        .clock(clock),
        .pin(hungry_filter_pin),
        .tick(microsecond),
        .limit(hungry_filter_limit),
        .load(hungry_filter_load),
        .synchronised(hungry_filter_synchronised),
        .value(hungry_filter_value)
    );
    rac4i65_core_dff_3 now (.d(now_d), .q(now_q), .clock(clock));
    rac4i65_core_dff_20 coming (.d(coming_d), .q(coming_q), .clock(clock));
    rac4i65_core_dff_10 gap (.d(gap_d), .q(gap_q), .clock(clock));
    rac4i65_core_dff_24_2 charged (.d(charged_d), .q(charged_q), .clock(clock));
    rac4i65_core_dff_1 spent (.d(spent_d), .q(spent_q), .clock(clock));
    rac4i65_core_dff_1 charge_pin (.d(charge_pin_d), .q(charge_pin_q), .clock(clock));
    rac4i65_core_dff_1 trigger_pin (.d(trigger_pin_d), .q(trigger_pin_q), .clock(clock));
    rac4i65_core_dff_1 is_ready (.d(is_ready_d), .q(is_ready_q), .clock(clock));
    rac4i65_core_dff_1 timed_out_flag (.d(timed_out_flag_d), .q(timed_out_flag_q), .clock(clock));
    rac4i65_core_dff_1 dropped_flag (.d(dropped_flag_d), .q(dropped_flag_q), .clock(clock));

    always @(*) begin
        now_d = now_q;
        ball_filter_limit = ball_limit;
        ball_filter_load = 1'b0;
        hungry_filter_limit = ball_limit;
        hungry_filter_load = 1'b0;
        now_d = next_state;
    end

    always @(*) begin
        coming_d = coming_q;
        next_state = now_q;
        if (in_ready) begin
            next_state = idle;
            if (accepts) begin
                next_state = pending_state;
            end
        end
        else if (in_pending) begin
            if (cancels) begin
                next_state = idle;
            end
            else if (microsecond & gap_over) begin
                next_state = pulse_state;
                coming_d = one;
            end
        end
        else if (in_pulse) begin
            if (microsecond) begin
                coming_d = after;
            end
            if (~enable | (microsecond & pulse_over)) begin
                next_state = commutation_state;
                coming_d = one;
            end
        end
        else if (now_q == commutation_state) begin
            if (microsecond) begin
                coming_d = after;
                if (coming_q >= commutation_time) begin
                    next_state = lockout_state;
                end
            end
        end
        else if (now_q == lockout_state) begin
            if (microsecond) begin
                coming_d = after;
                if (lockout_over) begin
                    next_state = idle;
                end
            end
        end
        else begin
            next_state = idle;
        end
    end

    always @(*) begin
        gap_d = gap_q;
        if (charge_pin_q) begin
            gap_d = charge_gap;
        end
        else if (microsecond & ~gap_over) begin
            gap_d = gap_q - gap_one;
        end
    end

    always @(*) begin
        charged_d = charged_q;
        if (microsecond & charge_pin_q & ~expired) begin
            charged_d = charged_q + charged_one;
        end
        if (~enable | stuffed | in_pulse) begin
            charged_d = charged_zero;
        end
    end

    always @(*) begin
        spent_d = spent_q;
        spent_d = arm_on_ball & (spent_q | ~enable | accepts);
    end

    always @(*) begin
        charge_pin_d = charge_pin_q;
        charge_pin_d = enable & charge_request & ~stuffed & ~expired & may_charge;
    end

    always @(*) begin
        trigger_pin_d = trigger_pin_q;
        trigger_pin_d = next_state == pulse_state;
    end

    always @(*) begin
        is_ready_d = is_ready_q;
        is_ready_d = (next_state == ready_state) & has_pulse;
    end

    always @(*) begin
        timed_out_flag_d = timed_out_flag_q;
        timed_out_flag_d = (timed_out_flag_q & ~clears_time_out) | (charge_pin_q & expired);
    end

    always @(*) begin
        dropped_flag_d = dropped_flag_q;
        dropped_flag_d = (dropped_flag_q & ~clear) | (fire & ~takes) | cancels;
    end

    always @(*) hungry_filter_pin = ~full;
    always @(*) stuffed = ~hungry_filter_value & ~by_time;
    always @(*) is_full = ~hungry_filter_value;

    always @(*) begin
        in_ready = now_q == ready_state;
        in_pending = now_q == pending_state;
        in_pulse = now_q == pulse_state;
        state = now_q;
    end

    always @(*) has_pulse = |pulse;
    always @(*) takes = in_ready & enable & has_pulse;
    always @(*) by_ball = arm_on_ball & ball_filter_value & ~spent_q;
    always @(*) accepts = takes & (fire | by_ball);
    always @(*) cancels = in_pending & ~(enable & has_pulse);
    always @(*) gap_over = ~|gap_q;

    always @(*) begin
        after = coming_q + one;
        short_coming = coming_q[(32'h0)+:(14)];
    end

    always @(*) pulse_over = (short_coming >= pulse) | (short_coming >= maximum_pulse);
    always @(*) lockout_over = (coming_q >= lockout) & (coming_q >= minimum_lockout);

    always @(*) begin
        idle = off_state;
        if (enable) begin
            idle = ready_state;
        end
    end

    always @(*) expired = charged_q >= charge_timeout;
    always @(*) may_charge = (next_state == ready_state) | (next_state == lockout_state);
    always @(*) clears_time_out = clear & (~expired | ~enable);
    always @(*) charge = charge_pin_q;
    always @(*) trigger = trigger_pin_q;
    always @(*) ready = is_ready_q;
    always @(*) timed_out = timed_out_flag_q;
    always @(*) dropped = dropped_flag_q;
    always @(*) on_ball = arm_on_ball & ~spent_q;
endmodule

module rac4i65_core_monitor (
    input wire lclk,
    input wire synclk,
    output reg lclk_dead
);

    // Constants
    localparam silent_zero = 5'b0;
    localparam silent_one = 5'b1;
    localparam silent_limit = 5'b11111;
    localparam good_zero = 8'h0;
    localparam good_one = 8'h1;
    localparam good_limit = 8'hff;

    // Pins of the parts
    reg toggle_d;
    wire toggle_q;

    reg first_d;
    wire first_q;

    reg second_d;
    wire second_q;

    reg last_d;
    wire last_q;

    reg [4:0] silent_d;
    wire [4:0] silent_q;

    reg [7:0] good_d;
    wire [7:0] good_q;

    reg alive_d;
    wire alive_q;

    // Parts
    rac4i65_core_dff_1 toggle (.d(toggle_d), .q(toggle_q), .clock(lclk));
    rac4i65_core_dff_1 first (.d(first_d), .q(first_q), .clock(synclk));
    rac4i65_core_dff_1 second (.d(second_d), .q(second_q), .clock(synclk));
    rac4i65_core_dff_1 last (.d(last_d), .q(last_q), .clock(synclk));
    rac4i65_core_dff_5 silent (.d(silent_d), .q(silent_q), .clock(synclk));
    rac4i65_core_dff_8 good (.d(good_d), .q(good_q), .clock(synclk));
    rac4i65_core_dff_1 alive (.d(alive_d), .q(alive_q), .clock(synclk));

    always @(*) begin
        toggle_d = toggle_q;
        toggle_d = ~toggle_q;
    end

    always @(*) begin
        first_d = first_q;
        first_d = toggle_q;
    end

    always @(*) begin
        second_d = second_q;
        second_d = first_q;
    end

    always @(*) begin
        last_d = last_q;
        last_d = second_q;
    end

    always @(*) begin
        silent_d = silent_q;
        good_d = good_q;
        alive_d = alive_q;
        if (second_q ^ last_q) begin
            silent_d = silent_zero;
            if (good_q == good_limit) begin
                alive_d = 1'b1;
            end
            else begin
                good_d = good_q + good_one;
            end
        end
        else if (silent_q == silent_limit) begin
            good_d = good_zero;
            alive_d = 1'b0;
        end
        else begin
            silent_d = silent_q + silent_one;
        end
    end

    always @(*) lclk_dead = ~alive_q;
endmodule

module rac4i65_core_sequencer (
    input wire clock,
    input wire tick,
    output reg running,
    output reg done,
    input wire configuration_bank,
    input wire set_point_bank,
    input wire [1:0] snapshot_bank,
    output reg [4:0] input_port,
    output reg [1:0] axis,
    input wire [31:0] input_data,
    output reg output_strobe,
    output reg [1:0] output_port,
    output reg [31:0] output_data,
    input wire [7:0] bus_address,
    output reg [31:0] bus_read_data,
    input wire [7:0] bus_write_address,
    input wire bus_write,
    input wire [31:0] bus_write_data,
    output reg bus_blocked
);

    // Constants
    localparam zero = 32'h0;
    localparam one_pc = 9'b1;
    localparam no_bank = 8'h0;
    localparam first_axis = 2'b0;
    localparam last_axis = 2'b11;
    localparam one_axis = 2'b1;
    localparam word_max = 32'h1fffffff;
    localparam word_min = 32'he0000000;
    localparam three_clear = 3'b0;
    localparam three_set = 3'b111;
    localparam mask_24 = 32'hffffff;
    localparam sign_of_16 = 32'hffff0000;
    localparam sign_of_8 = 32'hffffff00;
    localparam configuration_region = 8'h40;
    localparam set_point_region = 8'h8;
    localparam region_0 = 2'b0;
    localparam region_set_points = 5'b10000;
    localparam region_3 = 2'b11;

    // Pins of the parts

    wire [23:0] rom_read_data;

    reg [7:0] memory_read_address;
    wire [31:0] memory_read_data;
    reg [7:0] memory_write_address;
    reg [31:0] memory_write_data;
    reg memory_write_enable;

    wire [31:0] mirror_read_data;

    reg multiplier_start;
    reg [2:0] multiplier_scale;

    wire multiplier_busy;
    wire [31:0] multiplier_result;

    reg divider_start;

    wire divider_busy;
    wire [31:0] divider_quotient;
    reg [4:0] place_word;

    wire [7:0] place_address;
    reg active_d;
    wire active_q;

    reg [8:0] pc_d;
    wire [8:0] pc_q;

    reg [15:0] instruction_d;
    wire [15:0] instruction_q;

    reg [4:0] port_d;
    wire [4:0] port_q;

    reg nothing_d;
    wire nothing_q;

    reg subtracts_d;
    wire subtracts_q;

    reg waits_for_quotient_d;
    wire waits_for_quotient_q;

    reg waits_for_product_d;
    wire waits_for_product_q;

    reg halts_d;
    wire halts_q;

    reg stores_d;
    wire stores_q;

    reg jumps_d;
    wire jumps_q;

    reg jumps_by_zero_d;
    wire jumps_by_zero_q;

    reg jumps_by_bit_d;
    wire jumps_by_bit_q;

    reg jumps_by_sign_d;
    wire jumps_by_sign_q;

    reg jumps_by_axis_d;
    wire jumps_by_axis_q;

    reg jumps_if_not_d;
    wire jumps_if_not_q;

    reg [31:0] input_word_d;
    wire [31:0] input_word_q;

    reg [31:0] total_d;
    wire [31:0] total_q;

    reg total_negated_d;
    wire total_negated_q;

    reg finishing_d;
    wire finishing_q;

    reg saturates_d;
    wire saturates_q;

    reg cuts_16_d;
    wire cuts_16_q;

    reg cuts_24_d;
    wire cuts_24_q;

    reg storing_d;
    wire storing_q;

    reg [7:0] store_address_d;
    wire [7:0] store_address_q;

    reg valid_d;
    wire valid_q;

    reg [31:0] accumulator_d;
    wire [31:0] accumulator_q;

    reg [1:0] axis_number_d;
    wire [1:0] axis_number_q;

    reg bus_hits_d;
    wire bus_hits_q;

    reg [31:0] bus_written_d;
    wire [31:0] bus_written_q;

    // Intermediate values
    reg [8:0] pc_next;
    reg goes_on;
    reg read_stores;
    reg stall;
    reg branch;
    reg [15:0] read_instruction;
    reg [4:0] read_op;
    reg read_subtracts;
    reg read_jumps;
    reg read_waits_for_quotient;
    reg read_waits_for_product;
    reg read_halts;
    reg read_jumps_by_zero;
    reg read_jumps_by_bit;
    reg read_jumps_by_sign;
    reg read_jumps_by_axis;
    reg read_jumps_if_not;
    reg [7:0] read_address;
    reg [7:0] read_bank;
    reg [7:0] write_address;
    reg [4:0] op;
    reg [31:0] word;
    reg subtracting;
    reg [31:0] left;
    reg [31:0] sum;
    reg [2:0] sum_top;
    reg [31:0] saturated;
    reg [31:0] low_16;
    reg [31:0] immediate;

    // Parts
    rac4i65_core_sequencer_rom rom (.clock(clock), .read_address(pc_next), .read_data(rom_read_data));
    rac4i65_core_sequencer_memory memory(
        .clock(clock),
        .read_address(memory_read_address),
        .read_data(memory_read_data),
        .write_address(memory_write_address),
        .write_data(memory_write_data),
        .write_enable(memory_write_enable)
    );
    rac4i65_core_sequencer_memory mirror(
        .clock(clock),
        .read_address(bus_address),
        .read_data(mirror_read_data),
        .write_address(memory_write_address),
        .write_data(memory_write_data),
        .write_enable(memory_write_enable)
    );
    rac4i65_core_sequencer_multiplier multiplier(
        .clock(clock),
        .start(multiplier_start),
        .scale(multiplier_scale),
        .a(word),
        .b(accumulator_q),
        .busy(multiplier_busy),
        .result(multiplier_result)
    );
    rac4i65_core_sequencer_divider divider(
        .clock(clock),
        .start(divider_start),
        .numerator(accumulator_q),
        .denominator(word),
        .busy(divider_busy),
        .quotient(divider_quotient)
    );
    rac4i65_core_place place (.word(place_word), .bank(snapshot_bank), .address(place_address));
    rac4i65_core_dff_1 active (.d(active_d), .q(active_q), .clock(clock));
    rac4i65_core_dff_9 pc (.d(pc_d), .q(pc_q), .clock(clock));
    rac4i65_core_dff_16 instruction (.d(instruction_d), .q(instruction_q), .clock(clock));
    rac4i65_core_dff_5 port (.d(port_d), .q(port_q), .clock(clock));
    rac4i65_core_dff_1 nothing (.d(nothing_d), .q(nothing_q), .clock(clock));
    rac4i65_core_dff_1 subtracts (.d(subtracts_d), .q(subtracts_q), .clock(clock));
    rac4i65_core_dff_1 waits_for_quotient (.d(waits_for_quotient_d), .q(waits_for_quotient_q), .clock(clock));
    rac4i65_core_dff_1 waits_for_product (.d(waits_for_product_d), .q(waits_for_product_q), .clock(clock));
    rac4i65_core_dff_1 halts (.d(halts_d), .q(halts_q), .clock(clock));
    rac4i65_core_dff_1 stores (.d(stores_d), .q(stores_q), .clock(clock));
    rac4i65_core_dff_1 jumps (.d(jumps_d), .q(jumps_q), .clock(clock));
    rac4i65_core_dff_1 jumps_by_zero (.d(jumps_by_zero_d), .q(jumps_by_zero_q), .clock(clock));
    rac4i65_core_dff_1 jumps_by_bit (.d(jumps_by_bit_d), .q(jumps_by_bit_q), .clock(clock));
    rac4i65_core_dff_1 jumps_by_sign (.d(jumps_by_sign_d), .q(jumps_by_sign_q), .clock(clock));
    rac4i65_core_dff_1 jumps_by_axis (.d(jumps_by_axis_d), .q(jumps_by_axis_q), .clock(clock));
    rac4i65_core_dff_1 jumps_if_not (.d(jumps_if_not_d), .q(jumps_if_not_q), .clock(clock));
    rac4i65_core_dff_32 input_word (.d(input_word_d), .q(input_word_q), .clock(clock));
    rac4i65_core_dff_32 total (.d(total_d), .q(total_q), .clock(clock));
    rac4i65_core_dff_1 total_negated (.d(total_negated_d), .q(total_negated_q), .clock(clock));
    rac4i65_core_dff_1 finishing (.d(finishing_d), .q(finishing_q), .clock(clock));
    rac4i65_core_dff_1 saturates (.d(saturates_d), .q(saturates_q), .clock(clock));
    rac4i65_core_dff_1 cuts_16 (.d(cuts_16_d), .q(cuts_16_q), .clock(clock));
    rac4i65_core_dff_1 cuts_24 (.d(cuts_24_d), .q(cuts_24_q), .clock(clock));
    rac4i65_core_dff_1 storing (.d(storing_d), .q(storing_q), .clock(clock));
    rac4i65_core_dff_8 store_address (.d(store_address_d), .q(store_address_q), .clock(clock));
    rac4i65_core_dff_1 valid (.d(valid_d), .q(valid_q), .clock(clock));
    rac4i65_core_dff_32 accumulator (.d(accumulator_d), .q(accumulator_q), .clock(clock));
    rac4i65_core_dff_2 axis_number (.d(axis_number_d), .q(axis_number_q), .clock(clock));
    rac4i65_core_dff_1 bus_hits (.d(bus_hits_d), .q(bus_hits_q), .clock(clock));
    rac4i65_core_dff_32 bus_written (.d(bus_written_d), .q(bus_written_q), .clock(clock));

    always @(*) begin
        active_d = active_q;
        if (done) begin
            active_d = 1'b0;
        end
        if (tick & ~active_q) begin
            active_d = 1'b1;
        end
    end

    always @(*) begin
        pc_d = pc_q;
        pc_d = pc_next;
    end

    always @(*) begin
        instruction_d = instruction_q;
        subtracts_d = subtracts_q;
        valid_d = valid_q;
        waits_for_quotient_d = waits_for_quotient_q;
        waits_for_product_d = waits_for_product_q;
        halts_d = halts_q;
        stores_d = stores_q;
        jumps_d = jumps_q;
        jumps_by_zero_d = jumps_by_zero_q;
        jumps_by_bit_d = jumps_by_bit_q;
        jumps_by_sign_d = jumps_by_sign_q;
        jumps_by_axis_d = jumps_by_axis_q;
        jumps_if_not_d = jumps_if_not_q;
        if (goes_on) begin
            instruction_d = read_instruction;
            subtracts_d = read_subtracts;
            jumps_d = read_jumps;
            jumps_by_zero_d = read_jumps_by_zero;
            jumps_by_bit_d = read_jumps_by_bit;
            jumps_by_sign_d = read_jumps_by_sign;
            waits_for_quotient_d = read_waits_for_quotient;
            waits_for_product_d = read_waits_for_product;
            halts_d = read_halts;
            stores_d = read_stores;
            jumps_by_axis_d = read_jumps_by_axis;
            jumps_if_not_d = read_jumps_if_not;
            valid_d = 1'b1;
        end
        pc_next = pc_q;
        if (goes_on) begin
            pc_next = pc_q + one_pc;
        end
        if (branch | done) begin
            pc_next = instruction_q[(32'h0)+:(9)];
            valid_d = 1'b0;
            jumps_d = 1'b0;
            jumps_by_zero_d = 1'b0;
            jumps_by_bit_d = 1'b0;
            jumps_by_sign_d = 1'b0;
            jumps_by_axis_d = 1'b0;
            waits_for_quotient_d = 1'b0;
            waits_for_product_d = 1'b0;
            halts_d = 1'b0;
            stores_d = 1'b0;
        end
    end

    always @(*) begin
        accumulator_d = accumulator_q;
        axis_number_d = axis_number_q;
        finishing_d = finishing_q;
        saturates_d = saturates_q;
        cuts_16_d = cuts_16_q;
        cuts_24_d = cuts_24_q;
        finishing_d = 1'b0;
        saturates_d = 1'b0;
        cuts_16_d = 1'b0;
        cuts_24_d = 1'b0;
        output_strobe = 1'b0;
        multiplier_start = 1'b0;
        divider_start = 1'b0;
        if (finishing_q) begin
            accumulator_d = sum;
        end
        if (saturates_q) begin
            accumulator_d = saturated;
        end
        if (cuts_16_q) begin
            accumulator_d = low_16;
        end
        if (cuts_24_q) begin
            accumulator_d = sum & mask_24;
        end
        if (valid_q) begin
            if (op[32'h4] & op[32'h3]) begin
                multiplier_start = 1'b1;
            end
            else begin
                case (op)
                    1:
                    begin
                        accumulator_d = word;
                    end
                    2:
                    begin
                        accumulator_d = immediate;
                    end
                    3:
                    begin
                        saturates_d = 1'b1;
                    end
                    4:
                    begin
                        saturates_d = 1'b1;
                    end
                    5:
                    begin
                        finishing_d = 1'b1;
                    end
                    6:
                    begin
                        cuts_16_d = 1'b1;
                    end
                    7:
                    begin
                        cuts_24_d = 1'b1;
                    end
                    9:
                    begin
                        if (sum[32'h1f] == instruction_q[32'h9]) begin
                            accumulator_d = word;
                        end
                    end
                    10:
                    begin
                        accumulator_d = accumulator_q ^ word;
                    end
                    12:
                    begin
                        accumulator_d = input_word_q;
                    end
                    13:
                    begin
                        output_strobe = 1'b1;
                    end
                    19:
                    begin
                        if (axis_number_q == last_axis) begin
                            axis_number_d = first_axis;
                        end
                        else begin
                            axis_number_d = axis_number_q + one_axis;
                        end
                    end
                    21:
                    begin
                        divider_start = 1'b1;
                    end
                    22:
                    begin
                        accumulator_d = divider_quotient;
                    end
                    23:
                    begin
                        accumulator_d = multiplier_result;
                    end
                    default:
                    begin
                        output_strobe = 1'b0;
                    end
                endcase
            end
        end
    end

    always @(*) begin
        port_d = port_q;
        if (~stall) begin
            port_d = rom_read_data[(32'h10)+:(5)];
        end
    end

    always @(*) begin
        nothing_d = nothing_q;
        nothing_d = accumulator_q == zero;
    end

    always @(*) begin
        bus_hits_d = bus_hits_q;
        bus_hits_d = memory_write_enable & (memory_write_address == bus_address);
    end

    always @(*) begin
        bus_written_d = bus_written_q;
        bus_written_d = memory_write_data;
    end

    always @(*) begin
        input_word_d = input_word_q;
        input_word_d = input_data;
    end

    always @(*) begin
        total_d = total_q;
        total_d = left + word;
    end

    always @(*) begin
        total_negated_d = total_negated_q;
        total_negated_d = subtracting;
    end

    always @(*) begin
        storing_d = storing_q;
        storing_d = stores_q;
    end

    always @(*) begin
        store_address_d = store_address_q;
        store_address_d = write_address;
        if (write_address[(32'h6)+:(2)] == region_3) begin
            store_address_d = place_address;
        end
    end

    always @(*) read_instruction = rom_read_data[(32'h0)+:(16)];

    always @(*) begin
        read_address = read_instruction[(32'h0)+:(8)];
        if (read_instruction[32'ha]) begin
            read_address = read_instruction[(32'h0)+:(8)] | ((axis_number_q) & 8'hff);
        end
    end

    always @(*) begin
        read_bank = no_bank;
        if (configuration_bank & (read_address[(32'h6)+:(2)] == region_0)) begin
            read_bank = configuration_region;
        end
        if (set_point_bank & (read_address[(32'h3)+:(5)] == region_set_points)) begin
            read_bank = set_point_region;
        end
    end

    always @(*) memory_read_address = read_address | read_bank;

    always @(*) begin
        op = instruction_q[(32'hb)+:(5)];
        output_port = instruction_q[(32'h0)+:(2)];
    end

    always @(*) word = memory_read_data;
    always @(*) stall = (waits_for_quotient_q & divider_busy) | (waits_for_product_q & multiplier_busy);
    always @(*) done = halts_q;
    always @(*) read_op = read_instruction[(32'hb)+:(5)];

    always @(*) begin
        read_subtracts = 1'b0;
        read_jumps = 1'b0;
        read_jumps_by_zero = 1'b0;
        read_jumps_by_bit = 1'b0;
        read_waits_for_quotient = 1'b0;
        read_waits_for_product = 1'b0;
        read_halts = 1'b0;
        read_stores = 1'b0;
        read_jumps_by_sign = 1'b0;
        read_jumps_by_axis = 1'b0;
        read_jumps_if_not = 1'b0;
        case (read_op)
            4:
            begin
                read_subtracts = 1'b1;
            end
            6:
            begin
                read_subtracts = 1'b1;
            end
            7:
            begin
                read_subtracts = 1'b1;
            end
            8:
            begin
                read_subtracts = 1'b1;
            end
            11:
            begin
                read_stores = 1'b1;
            end
            14:
            begin
                read_jumps = 1'b1;
            end
            15:
            begin
                read_jumps_by_zero = 1'b1;
            end
            16:
            begin
                read_jumps_by_bit = 1'b1;
            end
            17:
            begin
                read_jumps_by_sign = 1'b1;
            end
            18:
            begin
                read_jumps_by_sign = 1'b1;
                read_jumps_if_not = 1'b1;
            end
            19:
            begin
                read_jumps_by_axis = 1'b1;
            end
            20:
            begin
                read_halts = 1'b1;
            end
            22:
            begin
                read_waits_for_quotient = 1'b1;
            end
            23:
            begin
                read_waits_for_product = 1'b1;
            end
            default:
            begin
                read_subtracts = 1'b0;
            end
        endcase
    end

    always @(*) branch = jumps_q | (jumps_by_zero_q & nothing_q) | (jumps_by_bit_q & ~accumulator_q[32'h0]) | (jumps_by_sign_q & (accumulator_q[32'h1f] != jumps_if_not_q)) | (jumps_by_axis_q & (axis_number_q != last_axis));
    always @(*) subtracting = subtracts_q;

    always @(*) begin
        left = accumulator_q;
        if (subtracting) begin
            left = ~accumulator_q;
        end
    end

    always @(*) begin
        sum = total_q;
        if (total_negated_q) begin
            sum = ~total_q;
        end
    end

    always @(*) sum_top = sum[(32'h1d)+:(3)];

    always @(*) begin
        saturated = sum;
        if ((sum_top != three_clear) & (sum_top != three_set)) begin
            saturated = word_max;
            if (sum[32'h1f]) begin
                saturated = word_min;
            end
        end
    end

    always @(*) begin
        low_16 = ((sum[(32'h0)+:(16)]) & 32'hffffffff);
        if (sum[32'hf]) begin
            low_16 = ((sum[(32'h0)+:(16)]) & 32'hffffffff) | sign_of_16;
        end
    end

    always @(*) begin
        immediate = ((instruction_q[(32'h0)+:(8)]) & 32'hffffffff);
        if (instruction_q[32'h7]) begin
            immediate = ((instruction_q[(32'h0)+:(8)]) & 32'hffffffff) | sign_of_8;
        end
    end

    always @(*) multiplier_scale = op[(32'h0)+:(3)];
    always @(*) goes_on = active_q & ~stall;
    always @(*) running = active_q;

    always @(*) begin
        write_address = instruction_q[(32'h0)+:(8)];
        if (instruction_q[32'ha]) begin
            write_address = instruction_q[(32'h0)+:(8)] | ((axis_number_q) & 8'hff);
        end
    end

    always @(*) place_word = write_address[(32'h0)+:(5)];

    always @(*) begin
        memory_write_address = bus_write_address;
        memory_write_data = bus_write_data;
        if (storing_q) begin
            memory_write_address = store_address_q;
            memory_write_data = accumulator_q;
        end
    end

    always @(*) memory_write_enable = storing_q | bus_write;

    always @(*) begin
        bus_read_data = mirror_read_data;
        if (bus_hits_q) begin
            bus_read_data = bus_written_q;
        end
    end

    always @(*) bus_blocked = stores_q;
    always @(*) input_port = port_q;
    always @(*) axis = axis_number_q;
    always @(*) output_data = accumulator_q;
endmodule

module rac4i65_core_sequencer_rom (
    input wire clock,
    input wire [8:0] read_address,
    output reg [23:0] read_data
);

    (* no_rw_check *)
    reg [23:0] mem [0:511];

    initial begin
        read_data = 24'h0;
        mem[0] = 24'h81000;
        mem[1] = 24'h958a8;
        mem[2] = 24'ha58a9;
        mem[3] = 24'h58aa;
        mem[4] = 24'h0;
        mem[5] = 24'h106000;
        mem[6] = 24'h103490;
        mem[7] = 24'h1058b0;
        mem[8] = 24'h102c90;
        mem[9] = 24'h105c90;
        mem[10] = 24'hc08b0;
        mem[11] = 24'hce40c;
        mem[12] = 24'h1c600c;
        mem[13] = 24'he801c;
        mem[14] = 24'h10600e;
        mem[15] = 24'h3490;
        mem[16] = 24'h100000;
        mem[17] = 24'h192c90;
        mem[18] = 24'hc58b9;
        mem[19] = 24'h1c2c8c;
        mem[20] = 24'hd5c9c;
        mem[21] = 24'h1c600d;
        mem[22] = 24'h19801c;
        mem[23] = 24'h1e08b9;
        mem[24] = 24'h28be;
        mem[25] = 24'h1e0000;
        mem[26] = 24'hc50be;
        mem[27] = 24'h5c8c;
        mem[28] = 24'h8b800;
        mem[29] = 24'h818a8;
        mem[30] = 24'h1058a8;
        mem[31] = 24'h1008b0;
        mem[32] = 24'h5e410;
        mem[33] = 24'h1d6005;
        mem[34] = 24'h180fd;
        mem[35] = 24'h146001;
        mem[36] = 24'h123c94;
        mem[37] = 24'h58b2;
        mem[38] = 24'h1c0000;
        mem[39] = 24'h18783c;
        mem[40] = 24'hf0c98;
        mem[41] = 24'h2882f;
        mem[42] = 24'h186002;
        mem[43] = 24'h3498;
        mem[44] = 24'h120000;
        mem[45] = 24'h15a8b2;
        mem[46] = 24'h7035;
        mem[47] = 24'h40000;
        mem[48] = 24'h126004;
        mem[49] = 24'h1058b2;
        mem[50] = 24'h8b0;
        mem[51] = 24'h120000;
        mem[52] = 24'ha8b2;
        mem[53] = 24'h10000;
        mem[54] = 24'h146001;
        mem[55] = 24'h25c94;
        mem[56] = 24'h186002;
        mem[57] = 24'h5c98;
        mem[58] = 24'h61000;
        mem[59] = 24'h187046;
        mem[60] = 24'h40c98;
        mem[61] = 24'h38904;
        mem[62] = 24'h146003;
        mem[63] = 24'h123c94;
        mem[64] = 24'h1c58b2;
        mem[65] = 24'h20bc;
        mem[66] = 24'h40000;
        mem[67] = 24'h19104;
        mem[68] = 24'h121001;
        mem[69] = 24'h11a8b2;
        mem[70] = 24'h58b1;
        mem[71] = 24'h9b800;
        mem[72] = 24'h918a9;
        mem[73] = 24'h758a9;
        mem[74] = 24'h76007;
        mem[75] = 24'h88107;
        mem[76] = 24'h96008;
        mem[77] = 24'h68109;
        mem[78] = 24'hb6006;
        mem[79] = 24'h810b;
        mem[80] = 24'hc00;
        mem[81] = 24'hc080;
        mem[82] = 24'h19b800;
        mem[83] = 24'h458b9;
        mem[84] = 24'h10c04;
        mem[85] = 24'hc081;
        mem[86] = 24'h17b800;
        mem[87] = 24'h858b7;
        mem[88] = 24'h20c08;
        mem[89] = 24'h17c082;
        mem[90] = 24'h1908b7;
        mem[91] = 24'h1918b9;
        mem[92] = 24'h58b9;
        mem[93] = 24'hb800;
        mem[94] = 24'h190000;
        mem[95] = 24'h18b9;
        mem[96] = 24'hc0000;
        mem[97] = 24'h24ac;
        mem[98] = 24'h100000;
        mem[99] = 24'h104430;
        mem[100] = 24'hc4c30;
        mem[101] = 24'hc442c;
        mem[102] = 24'hc4e2c;
        mem[103] = 24'hc1cac;
        mem[104] = 24'hc5cac;
        mem[105] = 24'h85ccc;
        mem[106] = 24'hc0c28;
        mem[107] = 24'h11c4ac;
        mem[108] = 24'h1008b1;
        mem[109] = 24'h128910;
        mem[110] = 24'h8112;
        mem[111] = 24'h19b000;
        mem[112] = 24'h58b9;
        mem[113] = 24'hd0ca0;
        mem[114] = 24'h910d;
        mem[115] = 24'h191000;
        mem[116] = 24'h20b9;
        mem[117] = 24'h0;
        mem[118] = 24'h44a0;
        mem[119] = 24'h4ea0;
        mem[120] = 24'h85ca0;
        mem[121] = 24'h5cc8;
        mem[122] = 24'h13b800;
        mem[123] = 24'hc58b3;
        mem[124] = 24'hcac;
        mem[125] = 24'h1424a0;
        mem[126] = 24'h1858b4;
        mem[127] = 24'hc18;
        mem[128] = 24'h140000;
        mem[129] = 24'h7d0b4;
        mem[130] = 24'h196007;
        mem[131] = 24'h8119;
        mem[132] = 24'h15b800;
        mem[133] = 24'h1c58b5;
        mem[134] = 24'h140c1c;
        mem[135] = 24'h15c8b4;
        mem[136] = 24'h1308b5;
        mem[137] = 24'h1518b3;
        mem[138] = 24'h58b5;
        mem[139] = 24'h4b800;
        mem[140] = 24'h121ca4;
        mem[141] = 24'h1058b2;
        mem[142] = 24'h1408b0;
        mem[143] = 24'h12e414;
        mem[144] = 24'h1508b2;
        mem[145] = 24'h1718b5;
        mem[146] = 24'h458b7;
        mem[147] = 24'h44424;
        mem[148] = 24'h4c24;
        mem[149] = 24'h4420;
        mem[150] = 24'h184e20;
        mem[151] = 24'h1758b8;
        mem[152] = 24'h20b7;
        mem[153] = 24'h0;
        mem[154] = 24'h160000;
        mem[155] = 24'h177916;
        mem[156] = 24'h1408b7;
        mem[157] = 24'h1650b4;
        mem[158] = 24'h158916;
        mem[159] = 24'h408b5;
        mem[160] = 24'h1ca4;
        mem[161] = 24'h40000;
        mem[162] = 24'h44424;
        mem[163] = 24'h4c24;
        mem[164] = 24'h4420;
        mem[165] = 24'h184e20;
        mem[166] = 24'h58b8;
        mem[167] = 24'h0;
        mem[168] = 24'h180000;
        mem[169] = 24'h8b8;
        mem[170] = 24'he6800;
        mem[171] = 24'h90ae;
        mem[172] = 24'h181000;
        mem[173] = 24'h1920b8;
        mem[174] = 24'h58b9;
        mem[175] = 24'hab800;
        mem[176] = 24'ha18aa;
        mem[177] = 24'h958aa;
        mem[178] = 24'h196009;
        mem[179] = 24'h18d8b9;
        mem[180] = 24'h1008b8;
        mem[181] = 24'h105cd0;
        mem[182] = 24'hc0c90;
        mem[183] = 24'h42c8c;
        mem[184] = 24'h5cc4;
        mem[185] = 24'h1db800;
        mem[186] = 24'h18bd;
        mem[187] = 24'h10000;
        mem[188] = 24'h46801;
        mem[189] = 24'hf9804;
        mem[190] = 24'h600f;
        mem[191] = 24'h168120;
        mem[192] = 24'ha08b6;
        mem[193] = 24'h28aa;
        mem[194] = 24'h20000;
        mem[195] = 24'ha6802;
        mem[196] = 24'h1628aa;
        mem[197] = 24'h1658b6;
        mem[198] = 24'h1058d6;
        mem[199] = 24'h1f6010;
        mem[200] = 24'hc0bf;
        mem[201] = 24'h19b800;
        mem[202] = 24'h958b9;
        mem[203] = 24'hc8a9;
        mem[204] = 24'h10b800;
        mem[205] = 24'h858b0;
        mem[206] = 24'h8a8;
        mem[207] = 24'h100000;
        mem[208] = 24'h1420b0;
        mem[209] = 24'h1958b4;
        mem[210] = 24'h808b9;
        mem[211] = 24'hc8a8;
        mem[212] = 24'h9b800;
        mem[213] = 24'h1718a9;
        mem[214] = 24'h1158b7;
        mem[215] = 24'h6011;
        mem[216] = 24'h170000;
        mem[217] = 24'hc0b7;
        mem[218] = 24'h10b800;
        mem[219] = 24'h1258b0;
        mem[220] = 24'h146012;
        mem[221] = 24'hc0b4;
        mem[222] = 24'h10b800;
        mem[223] = 24'h20b0;
        mem[224] = 24'h1a0000;
        mem[225] = 24'h1a28ba;
        mem[226] = 24'h1458ba;
        mem[227] = 24'h1158d4;
        mem[228] = 24'h146011;
        mem[229] = 24'hc0b4;
        mem[230] = 24'h10b800;
        mem[231] = 24'h1258b0;
        mem[232] = 24'h176012;
        mem[233] = 24'hc0b7;
        mem[234] = 24'h10b800;
        mem[235] = 24'h18b0;
        mem[236] = 24'h1b0000;
        mem[237] = 24'h1b28bb;
        mem[238] = 24'h1558bb;
        mem[239] = 24'h58d5;
        mem[240] = 24'ha0000;
        mem[241] = 24'h1600a;
        mem[242] = 24'hb58c1;
        mem[243] = 24'h3600b;
        mem[244] = 24'h358c3;
        mem[245] = 24'h26003;
        mem[246] = 24'h158c2;
        mem[247] = 24'hb1001;
        mem[248] = 24'hb28ab;
        mem[249] = 24'h58ab;
        mem[250] = 24'h1758c0;
        mem[251] = 24'h58d7;
        mem[252] = 24'ha000;
        mem[253] = 24'h40000;
        mem[254] = 24'h126004;
        mem[255] = 24'h1058b2;
        mem[256] = 24'h8b0;
        mem[257] = 24'h120000;
        mem[258] = 24'h1aa8b2;
        mem[259] = 24'h1f703a;
        mem[260] = 24'h1810ff;
        mem[261] = 24'h65c98;
        mem[262] = 24'h7046;
        mem[263] = 24'h81000;
        mem[264] = 24'h7068;
        mem[265] = 24'h1000;
        mem[266] = 24'h7060;
        mem[267] = 24'hc80;
        mem[268] = 24'h197060;
        mem[269] = 24'h1940b9;
        mem[270] = 24'h1848b9;
        mem[271] = 24'h7078;
        mem[272] = 24'h181000;
        mem[273] = 24'h7078;
        mem[274] = 24'h18b000;
        mem[275] = 24'h1e9078;
        mem[276] = 24'h1820be;
        mem[277] = 24'h127078;
        mem[278] = 24'h408b2;
        mem[279] = 24'h75ca4;
        mem[280] = 24'h70a7;
        mem[281] = 24'h10b800;
        mem[282] = 24'h1408b0;
        mem[283] = 24'he414;
        mem[284] = 24'h181000;
        mem[285] = 24'h458b8;
        mem[286] = 24'h75ca4;
        mem[287] = 24'h70a7;
        mem[288] = 24'h1a1000;
        mem[289] = 24'h1b58ba;
        mem[290] = 24'h1658bb;
        mem[291] = 24'h1458b6;
        mem[292] = 24'h1558d4;
        mem[293] = 24'h1658d5;
        mem[294] = 24'h1058d6;
        mem[295] = 24'h70f0;
        mem[296] = 24'h0;
        mem[297] = 24'h0;
        mem[298] = 24'h0;
        mem[299] = 24'h0;
        mem[300] = 24'h0;
        mem[301] = 24'h0;
        mem[302] = 24'h0;
        mem[303] = 24'h0;
        mem[304] = 24'h0;
        mem[305] = 24'h0;
        mem[306] = 24'h0;
        mem[307] = 24'h0;
        mem[308] = 24'h0;
        mem[309] = 24'h0;
        mem[310] = 24'h0;
        mem[311] = 24'h0;
        mem[312] = 24'h0;
        mem[313] = 24'h0;
        mem[314] = 24'h0;
        mem[315] = 24'h0;
        mem[316] = 24'h0;
        mem[317] = 24'h0;
        mem[318] = 24'h0;
        mem[319] = 24'h0;
        mem[320] = 24'h0;
        mem[321] = 24'h0;
        mem[322] = 24'h0;
        mem[323] = 24'h0;
        mem[324] = 24'h0;
        mem[325] = 24'h0;
        mem[326] = 24'h0;
        mem[327] = 24'h0;
        mem[328] = 24'h0;
        mem[329] = 24'h0;
        mem[330] = 24'h0;
        mem[331] = 24'h0;
        mem[332] = 24'h0;
        mem[333] = 24'h0;
        mem[334] = 24'h0;
        mem[335] = 24'h0;
        mem[336] = 24'h0;
        mem[337] = 24'h0;
        mem[338] = 24'h0;
        mem[339] = 24'h0;
        mem[340] = 24'h0;
        mem[341] = 24'h0;
        mem[342] = 24'h0;
        mem[343] = 24'h0;
        mem[344] = 24'h0;
        mem[345] = 24'h0;
        mem[346] = 24'h0;
        mem[347] = 24'h0;
        mem[348] = 24'h0;
        mem[349] = 24'h0;
        mem[350] = 24'h0;
        mem[351] = 24'h0;
        mem[352] = 24'h0;
        mem[353] = 24'h0;
        mem[354] = 24'h0;
        mem[355] = 24'h0;
        mem[356] = 24'h0;
        mem[357] = 24'h0;
        mem[358] = 24'h0;
        mem[359] = 24'h0;
        mem[360] = 24'h0;
        mem[361] = 24'h0;
        mem[362] = 24'h0;
        mem[363] = 24'h0;
        mem[364] = 24'h0;
        mem[365] = 24'h0;
        mem[366] = 24'h0;
        mem[367] = 24'h0;
        mem[368] = 24'h0;
        mem[369] = 24'h0;
        mem[370] = 24'h0;
        mem[371] = 24'h0;
        mem[372] = 24'h0;
        mem[373] = 24'h0;
        mem[374] = 24'h0;
        mem[375] = 24'h0;
        mem[376] = 24'h0;
        mem[377] = 24'h0;
        mem[378] = 24'h0;
        mem[379] = 24'h0;
        mem[380] = 24'h0;
        mem[381] = 24'h0;
        mem[382] = 24'h0;
        mem[383] = 24'h0;
        mem[384] = 24'h0;
        mem[385] = 24'h0;
        mem[386] = 24'h0;
        mem[387] = 24'h0;
        mem[388] = 24'h0;
        mem[389] = 24'h0;
        mem[390] = 24'h0;
        mem[391] = 24'h0;
        mem[392] = 24'h0;
        mem[393] = 24'h0;
        mem[394] = 24'h0;
        mem[395] = 24'h0;
        mem[396] = 24'h0;
        mem[397] = 24'h0;
        mem[398] = 24'h0;
        mem[399] = 24'h0;
        mem[400] = 24'h0;
        mem[401] = 24'h0;
        mem[402] = 24'h0;
        mem[403] = 24'h0;
        mem[404] = 24'h0;
        mem[405] = 24'h0;
        mem[406] = 24'h0;
        mem[407] = 24'h0;
        mem[408] = 24'h0;
        mem[409] = 24'h0;
        mem[410] = 24'h0;
        mem[411] = 24'h0;
        mem[412] = 24'h0;
        mem[413] = 24'h0;
        mem[414] = 24'h0;
        mem[415] = 24'h0;
        mem[416] = 24'h0;
        mem[417] = 24'h0;
        mem[418] = 24'h0;
        mem[419] = 24'h0;
        mem[420] = 24'h0;
        mem[421] = 24'h0;
        mem[422] = 24'h0;
        mem[423] = 24'h0;
        mem[424] = 24'h0;
        mem[425] = 24'h0;
        mem[426] = 24'h0;
        mem[427] = 24'h0;
        mem[428] = 24'h0;
        mem[429] = 24'h0;
        mem[430] = 24'h0;
        mem[431] = 24'h0;
        mem[432] = 24'h0;
        mem[433] = 24'h0;
        mem[434] = 24'h0;
        mem[435] = 24'h0;
        mem[436] = 24'h0;
        mem[437] = 24'h0;
        mem[438] = 24'h0;
        mem[439] = 24'h0;
        mem[440] = 24'h0;
        mem[441] = 24'h0;
        mem[442] = 24'h0;
        mem[443] = 24'h0;
        mem[444] = 24'h0;
        mem[445] = 24'h0;
        mem[446] = 24'h0;
        mem[447] = 24'h0;
        mem[448] = 24'h0;
        mem[449] = 24'h0;
        mem[450] = 24'h0;
        mem[451] = 24'h0;
        mem[452] = 24'h0;
        mem[453] = 24'h0;
        mem[454] = 24'h0;
        mem[455] = 24'h0;
        mem[456] = 24'h0;
        mem[457] = 24'h0;
        mem[458] = 24'h0;
        mem[459] = 24'h0;
        mem[460] = 24'h0;
        mem[461] = 24'h0;
        mem[462] = 24'h0;
        mem[463] = 24'h0;
        mem[464] = 24'h0;
        mem[465] = 24'h0;
        mem[466] = 24'h0;
        mem[467] = 24'h0;
        mem[468] = 24'h0;
        mem[469] = 24'h0;
        mem[470] = 24'h0;
        mem[471] = 24'h0;
        mem[472] = 24'h0;
        mem[473] = 24'h0;
        mem[474] = 24'h0;
        mem[475] = 24'h0;
        mem[476] = 24'h0;
        mem[477] = 24'h0;
        mem[478] = 24'h0;
        mem[479] = 24'h0;
        mem[480] = 24'h0;
        mem[481] = 24'h0;
        mem[482] = 24'h0;
        mem[483] = 24'h0;
        mem[484] = 24'h0;
        mem[485] = 24'h0;
        mem[486] = 24'h0;
        mem[487] = 24'h0;
        mem[488] = 24'h0;
        mem[489] = 24'h0;
        mem[490] = 24'h0;
        mem[491] = 24'h0;
        mem[492] = 24'h0;
        mem[493] = 24'h0;
        mem[494] = 24'h0;
        mem[495] = 24'h0;
        mem[496] = 24'h0;
        mem[497] = 24'h0;
        mem[498] = 24'h0;
        mem[499] = 24'h0;
        mem[500] = 24'h0;
        mem[501] = 24'h0;
        mem[502] = 24'h0;
        mem[503] = 24'h0;
        mem[504] = 24'h0;
        mem[505] = 24'h0;
        mem[506] = 24'h0;
        mem[507] = 24'h0;
        mem[508] = 24'h0;
        mem[509] = 24'h0;
        mem[510] = 24'h0;
        mem[511] = 24'h0;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
    end
endmodule

module rac4i65_core_sequencer_memory (
    input wire clock,
    input wire [7:0] read_address,
    output reg [31:0] read_data,
    input wire [7:0] write_address,
    input wire [31:0] write_data,
    input wire write_enable
);

    (* no_rw_check *)
    reg [31:0] mem [0:255];

    initial begin
        read_data = 32'h0;
        mem[0] = 32'h0;
        mem[1] = 32'h0;
        mem[2] = 32'h0;
        mem[3] = 32'h0;
        mem[4] = 32'h0;
        mem[5] = 32'h0;
        mem[6] = 32'h0;
        mem[7] = 32'h0;
        mem[8] = 32'h0;
        mem[9] = 32'h0;
        mem[10] = 32'h0;
        mem[11] = 32'h0;
        mem[12] = 32'h0;
        mem[13] = 32'h0;
        mem[14] = 32'h0;
        mem[15] = 32'h0;
        mem[16] = 32'h0;
        mem[17] = 32'h0;
        mem[18] = 32'h0;
        mem[19] = 32'h0;
        mem[20] = 32'h0;
        mem[21] = 32'h0;
        mem[22] = 32'h0;
        mem[23] = 32'h0;
        mem[24] = 32'h0;
        mem[25] = 32'h0;
        mem[26] = 32'h0;
        mem[27] = 32'h0;
        mem[28] = 32'h0;
        mem[29] = 32'h0;
        mem[30] = 32'h0;
        mem[31] = 32'h0;
        mem[32] = 32'h0;
        mem[33] = 32'h0;
        mem[34] = 32'h0;
        mem[35] = 32'h0;
        mem[36] = 32'h0;
        mem[37] = 32'h0;
        mem[38] = 32'h0;
        mem[39] = 32'h0;
        mem[40] = 32'h0;
        mem[41] = 32'h0;
        mem[42] = 32'h0;
        mem[43] = 32'h0;
        mem[44] = 32'h0;
        mem[45] = 32'h0;
        mem[46] = 32'h0;
        mem[47] = 32'h0;
        mem[48] = 32'h0;
        mem[49] = 32'h0;
        mem[50] = 32'h0;
        mem[51] = 32'h0;
        mem[52] = 32'h0;
        mem[53] = 32'h0;
        mem[54] = 32'h0;
        mem[55] = 32'h0;
        mem[56] = 32'h0;
        mem[57] = 32'h0;
        mem[58] = 32'h0;
        mem[59] = 32'h0;
        mem[60] = 32'h0;
        mem[61] = 32'h0;
        mem[62] = 32'h0;
        mem[63] = 32'h0;
        mem[64] = 32'h0;
        mem[65] = 32'h0;
        mem[66] = 32'h0;
        mem[67] = 32'h0;
        mem[68] = 32'h0;
        mem[69] = 32'h0;
        mem[70] = 32'h0;
        mem[71] = 32'h0;
        mem[72] = 32'h0;
        mem[73] = 32'h0;
        mem[74] = 32'h0;
        mem[75] = 32'h0;
        mem[76] = 32'h0;
        mem[77] = 32'h0;
        mem[78] = 32'h0;
        mem[79] = 32'h0;
        mem[80] = 32'h0;
        mem[81] = 32'h0;
        mem[82] = 32'h0;
        mem[83] = 32'h0;
        mem[84] = 32'h0;
        mem[85] = 32'h0;
        mem[86] = 32'h0;
        mem[87] = 32'h0;
        mem[88] = 32'h0;
        mem[89] = 32'h0;
        mem[90] = 32'h0;
        mem[91] = 32'h0;
        mem[92] = 32'h0;
        mem[93] = 32'h0;
        mem[94] = 32'h0;
        mem[95] = 32'h0;
        mem[96] = 32'h0;
        mem[97] = 32'h0;
        mem[98] = 32'h0;
        mem[99] = 32'h0;
        mem[100] = 32'h0;
        mem[101] = 32'h0;
        mem[102] = 32'h0;
        mem[103] = 32'h0;
        mem[104] = 32'h0;
        mem[105] = 32'h0;
        mem[106] = 32'h0;
        mem[107] = 32'h0;
        mem[108] = 32'h0;
        mem[109] = 32'h0;
        mem[110] = 32'h0;
        mem[111] = 32'h0;
        mem[112] = 32'h0;
        mem[113] = 32'h0;
        mem[114] = 32'h0;
        mem[115] = 32'h0;
        mem[116] = 32'h0;
        mem[117] = 32'h0;
        mem[118] = 32'h0;
        mem[119] = 32'h0;
        mem[120] = 32'h0;
        mem[121] = 32'h0;
        mem[122] = 32'h0;
        mem[123] = 32'h0;
        mem[124] = 32'h0;
        mem[125] = 32'h0;
        mem[126] = 32'h0;
        mem[127] = 32'h0;
        mem[128] = 32'h0;
        mem[129] = 32'h0;
        mem[130] = 32'h0;
        mem[131] = 32'h0;
        mem[132] = 32'h0;
        mem[133] = 32'h0;
        mem[134] = 32'h0;
        mem[135] = 32'h0;
        mem[136] = 32'h0;
        mem[137] = 32'h0;
        mem[138] = 32'h0;
        mem[139] = 32'h0;
        mem[140] = 32'h0;
        mem[141] = 32'h0;
        mem[142] = 32'h0;
        mem[143] = 32'h0;
        mem[144] = 32'h0;
        mem[145] = 32'h0;
        mem[146] = 32'h0;
        mem[147] = 32'h0;
        mem[148] = 32'h0;
        mem[149] = 32'h0;
        mem[150] = 32'h0;
        mem[151] = 32'h0;
        mem[152] = 32'hffffffff;
        mem[153] = 32'hffffffff;
        mem[154] = 32'hffffffff;
        mem[155] = 32'hffffffff;
        mem[156] = 32'h0;
        mem[157] = 32'h0;
        mem[158] = 32'h0;
        mem[159] = 32'h0;
        mem[160] = 32'h0;
        mem[161] = 32'h0;
        mem[162] = 32'h0;
        mem[163] = 32'h0;
        mem[164] = 32'h0;
        mem[165] = 32'h0;
        mem[166] = 32'h0;
        mem[167] = 32'h0;
        mem[168] = 32'h0;
        mem[169] = 32'h0;
        mem[170] = 32'h0;
        mem[171] = 32'h0;
        mem[172] = 32'h0;
        mem[173] = 32'h0;
        mem[174] = 32'h0;
        mem[175] = 32'h0;
        mem[176] = 32'h0;
        mem[177] = 32'h0;
        mem[178] = 32'h0;
        mem[179] = 32'h0;
        mem[180] = 32'h0;
        mem[181] = 32'h0;
        mem[182] = 32'h0;
        mem[183] = 32'h0;
        mem[184] = 32'h0;
        mem[185] = 32'h0;
        mem[186] = 32'h0;
        mem[187] = 32'h0;
        mem[188] = 32'h800000;
        mem[189] = 32'h800;
        mem[190] = 32'hffffffff;
        mem[191] = 32'h1922;
        mem[192] = 32'h0;
        mem[193] = 32'h0;
        mem[194] = 32'h0;
        mem[195] = 32'h0;
        mem[196] = 32'h0;
        mem[197] = 32'h0;
        mem[198] = 32'h0;
        mem[199] = 32'h0;
        mem[200] = 32'h0;
        mem[201] = 32'h0;
        mem[202] = 32'h0;
        mem[203] = 32'h0;
        mem[204] = 32'h0;
        mem[205] = 32'h0;
        mem[206] = 32'h0;
        mem[207] = 32'h0;
        mem[208] = 32'h0;
        mem[209] = 32'h0;
        mem[210] = 32'h0;
        mem[211] = 32'h0;
        mem[212] = 32'h0;
        mem[213] = 32'h0;
        mem[214] = 32'h0;
        mem[215] = 32'h0;
        mem[216] = 32'h0;
        mem[217] = 32'h0;
        mem[218] = 32'h0;
        mem[219] = 32'h0;
        mem[220] = 32'h0;
        mem[221] = 32'h0;
        mem[222] = 32'h0;
        mem[223] = 32'h0;
        mem[224] = 32'h0;
        mem[225] = 32'h0;
        mem[226] = 32'h0;
        mem[227] = 32'h0;
        mem[228] = 32'h0;
        mem[229] = 32'h0;
        mem[230] = 32'h0;
        mem[231] = 32'h0;
        mem[232] = 32'h0;
        mem[233] = 32'h0;
        mem[234] = 32'h0;
        mem[235] = 32'h0;
        mem[236] = 32'h0;
        mem[237] = 32'h0;
        mem[238] = 32'h0;
        mem[239] = 32'h0;
        mem[240] = 32'h0;
        mem[241] = 32'h0;
        mem[242] = 32'h0;
        mem[243] = 32'h0;
        mem[244] = 32'h0;
        mem[245] = 32'h0;
        mem[246] = 32'h0;
        mem[247] = 32'h0;
        mem[248] = 32'h0;
        mem[249] = 32'h0;
        mem[250] = 32'h0;
        mem[251] = 32'h0;
        mem[252] = 32'h0;
        mem[253] = 32'h0;
        mem[254] = 32'h0;
        mem[255] = 32'h0;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
        if (write_enable) mem[write_address] <= write_data;
    end
endmodule

module rac4i65_core_sequencer_multiplier (
    input wire clock,
    input wire start,
    input wire [2:0] scale,
    input wire [31:0] a,
    input wire [31:0] b,
    output reg busy,
    output reg [31:0] result
);

    // Constants
    localparam zero = 32'h0;
    localparam digit_zero = 3'b0;
    localparam digit_plus_two = 3'b11;
    localparam digit_minus_two = 3'b100;
    localparam digit_minus_zero = 3'b111;
    localparam one_step = 4'h1;
    localparam steps_coefficient = 4'h9;
    localparam steps_gain = 4'hc;
    localparam steps_period = 4'h7;
    localparam half_coefficient = 32'h8000;
    localparam half_fine = 32'h200000;
    localparam half_wide = 32'h8000;
    localparam steps_counts = 4'h8;
    localparam half_counts = 32'h80;
    localparam half_period = 32'h800;
    localparam word_max = 32'h1fffffff;
    localparam word_min = 32'he0000000;
    localparam eleven_clear = 11'b0;
    localparam eleven_set = 11'b11111111111;
    localparam five_clear = 5'b0;
    localparam five_set = 5'b11111;

    // Pins of the parts
    reg [31:0] p_d;
    wire [31:0] p_q;

    reg [31:0] lo_d;
    wire [31:0] lo_q;

    reg [31:0] operand_d;
    wire [31:0] operand_q;

    reg [3:0] steps_d;
    wire [3:0] steps_q;

    reg working_d;
    wire working_q;

    reg negate_d;
    wire negate_q;

    reg twice_d;
    wire twice_q;

    reg nothing_d;
    wire nothing_q;

    reg guard_8_d;
    wire guard_8_q;

    // Intermediate values
    reg [31:0] addend;
    reg [31:0] left;
    reg [31:0] raw_sum;
    reg [31:0] sum;
    reg [2:0] digit;
    reg [31:0] shifted;
    reg [10:0] top;
    reg running;
    reg fits;
    reg sign;
    reg [4:0] top_5;

    // Parts
    rac4i65_core_dff_32 p (.d(p_d), .q(p_q), .clock(clock));
    rac4i65_core_dff_32 lo (.d(lo_d), .q(lo_q), .clock(clock));
    rac4i65_core_dff_32 operand (.d(operand_d), .q(operand_q), .clock(clock));
    rac4i65_core_dff_4 steps (.d(steps_d), .q(steps_q), .clock(clock));
    rac4i65_core_dff_1 working (.d(working_d), .q(working_q), .clock(clock));
    rac4i65_core_dff_1 negate (.d(negate_d), .q(negate_q), .clock(clock));
    rac4i65_core_dff_1 twice (.d(twice_d), .q(twice_q), .clock(clock));
    rac4i65_core_dff_1 nothing (.d(nothing_d), .q(nothing_q), .clock(clock));
    rac4i65_core_dff_1 guard_8 (.d(guard_8_d), .q(guard_8_q), .clock(clock));

    always @(*) begin
        p_d = p_q;
        lo_d = lo_q;
        operand_d = operand_q;
        steps_d = steps_q;
        working_d = working_q;
        guard_8_d = guard_8_q;
        if (running) begin
            steps_d = steps_q - one_step;
            working_d = steps_q != one_step;
            p_d = shifted | (((sign) & 32'hffffffff) << 32'h1e) | (((sign) & 32'hffffffff) << 32'h1f);
            lo_d = (lo_q >> 32'h2) | (((sum[(32'h0)+:(2)]) & 32'hffffffff) << 32'h1e);
        end
        else if (start) begin
            working_d = 1'b1;
            operand_d = a;
            lo_d = b;
            guard_8_d = 1'b0;
            case (scale)
                0:
                begin
                    p_d = half_coefficient;
                    steps_d = steps_coefficient;
                end
                1:
                begin
                    p_d = half_fine;
                    steps_d = steps_gain;
                end
                2:
                begin
                    p_d = half_wide;
                    steps_d = steps_gain;
                    guard_8_d = 1'b1;
                end
                3:
                begin
                    p_d = half_period;
                    steps_d = steps_period;
                end
                default:
                begin
                    p_d = half_counts;
                    steps_d = steps_counts;
                    guard_8_d = 1'b1;
                end
            endcase
        end
    end

    always @(*) begin
        negate_d = negate_q;
        negate_d = digit[32'h2];
    end

    always @(*) begin
        twice_d = twice_q;
        twice_d = (digit == digit_plus_two) | (digit == digit_minus_two);
    end

    always @(*) begin
        nothing_d = nothing_q;
        nothing_d = (digit == digit_zero) | (digit == digit_minus_zero);
    end

    always @(*) running = working_q;
    always @(*) busy = running;

    always @(*) begin
        digit = lo_q[(32'h1)+:(3)];
        if (~running) begin
            digit = ((b[(32'h0)+:(2)]) & 3'h7) << 32'h1;
        end
    end

    always @(*) begin
        addend = operand_q;
        if (twice_q) begin
            addend = operand_q << 32'h1;
        end
        if (nothing_q) begin
            addend = zero;
        end
    end

    always @(*) begin
        left = p_q;
        if (negate_q) begin
            left = ~p_q;
        end
    end

    always @(*) raw_sum = left + addend;

    always @(*) begin
        sum = raw_sum;
        if (negate_q) begin
            sum = ~raw_sum;
        end
    end

    always @(*) begin
        shifted = sum >> 32'h2;
        sign = sum[(32'h1f)+:(1)];
    end

    always @(*) begin
        top = p_q[(32'h15)+:(11)];
        top_5 = p_q[(32'h1b)+:(5)];
    end

    always @(*) begin
        if (guard_8_q) begin
            fits = (top == eleven_clear) | (top == eleven_set);
            result = (p_q << 32'h8) | ((lo_q[(32'h18)+:(8)]) & 32'hffffffff);
        end
        else begin
            fits = (top_5 == five_clear) | (top_5 == five_set);
            result = (p_q << 32'h2) | ((lo_q[(32'h1e)+:(2)]) & 32'hffffffff);
        end
        if (~fits) begin
            result = word_max;
            if (p_q[32'h1f]) begin
                result = word_min;
            end
        end
    end
endmodule

module rac4i65_core_sequencer_divider (
    input wire clock,
    input wire start,
    input wire [31:0] numerator,
    input wire [31:0] denominator,
    output reg busy,
    output reg [31:0] quotient
);

    // Constants
    localparam one_step = 6'b1;
    localparam word_steps = 6'b11101;
    localparam all_steps = 6'b100001;
    localparam bit_0 = 26'h1;
    localparam word_bit_0 = 29'h1;
    localparam sign_of_29 = 32'he0000000;

    // Pins of the parts
    reg [24:0] remainder_d;
    wire [24:0] remainder_q;

    reg last_bit_d;
    wire last_bit_q;

    reg [28:0] bits_d;
    wire [28:0] bits_q;

    reg [23:0] divisor_d;
    wire [23:0] divisor_q;

    reg [5:0] steps_d;
    wire [5:0] steps_q;

    reg working_d;
    wire working_q;

    reg negative_d;
    wire negative_q;

    reg overflow_d;
    wire overflow_q;

    // Intermediate values
    reg sign;
    reg [15:0] inverted;
    reg [15:0] magnitude;
    reg running;
    reg [25:0] minuend;
    reg [25:0] difference;
    reg goes;
    reg sets;

    // Parts
    rac4i65_core_dff_25 remainder (.d(remainder_d), .q(remainder_q), .clock(clock));
    rac4i65_core_dff_1 last_bit (.d(last_bit_d), .q(last_bit_q), .clock(clock));
    rac4i65_core_dff_29 bits (.d(bits_d), .q(bits_q), .clock(clock));
    rac4i65_core_dff_24_2 divisor (.d(divisor_d), .q(divisor_q), .clock(clock));
    rac4i65_core_dff_6 steps (.d(steps_d), .q(steps_q), .clock(clock));
    rac4i65_core_dff_1 working (.d(working_d), .q(working_q), .clock(clock));
    rac4i65_core_dff_1 negative (.d(negative_d), .q(negative_q), .clock(clock));
    rac4i65_core_dff_1 overflow (.d(overflow_d), .q(overflow_q), .clock(clock));

    always @(*) begin
        remainder_d = remainder_q;
        last_bit_d = last_bit_q;
        bits_d = bits_q;
        divisor_d = divisor_q;
        steps_d = steps_q;
        working_d = working_q;
        negative_d = negative_q;
        overflow_d = overflow_q;
        if (running) begin
            steps_d = steps_q - one_step;
            working_d = steps_q != one_step;
            last_bit_d = 1'b0;
            remainder_d = minuend[(32'h0)+:(25)];
            bits_d = bits_q << 32'h1;
            if (goes) begin
                remainder_d = difference[(32'h0)+:(25)];
            end
            if (sets ^ negative_q) begin
                bits_d = (bits_q << 32'h1) | word_bit_0;
            end
            if (goes & (steps_q > word_steps)) begin
                overflow_d = 1'b1;
            end
        end
        else if (start) begin
            remainder_d = ((magnitude[(32'h1)+:(15)]) & 25'h1ffffff);
            last_bit_d = magnitude[32'h0];
            negative_d = sign;
            divisor_d = denominator[(32'h0)+:(24)];
            overflow_d = 1'b0;
            steps_d = all_steps;
            working_d = 1'b1;
        end
    end

    always @(*) running = working_q;
    always @(*) busy = running;

    always @(*) begin
        minuend = ((remainder_q) & 26'h3ffffff) << 32'h1;
        if (last_bit_q) begin
            minuend = (((remainder_q) & 26'h3ffffff) << 32'h1) | bit_0;
        end
    end

    always @(*) difference = minuend - ((divisor_q) & 26'h3ffffff);
    always @(*) goes = ~difference[32'h19];
    always @(*) sets = goes | overflow_q;
    always @(*) sign = numerator[32'hf];

    always @(*) begin
        inverted = numerator[(32'h0)+:(16)];
        if (sign) begin
            inverted = ~numerator[(32'h0)+:(16)];
        end
    end

    always @(*) magnitude = inverted + ((sign) & 16'hffff);

    always @(*) begin
        quotient = ((bits_q) & 32'hffffffff);
        if (negative_q) begin
            quotient = ((bits_q) & 32'hffffffff) | sign_of_29;
        end
    end
endmodule

module rac4i65_core_trigonometry (
    input wire clock,
    input wire load,
    input wire [31:0] angle,
    output reg [17:0] sine,
    output reg [17:0] cosine,
    output reg [17:0] fraction
);

    // Constants
    localparam odd = 18'b1;
    localparam middle = 18'b100000000000000000;

    // Pins of the parts

    reg [7:0] sines_read_address;
    wire [15:0] sines_read_data;

    reg [7:0] cosines_read_address;
    wire [15:0] cosines_read_data;
    reg [27:0] held_d;
    wire [27:0] held_q;

    // Intermediate values
    reg [1:0] quadrant;
    reg [7:0] index;
    reg [15:0] sine_entry;
    reg [15:0] cosine_entry;
    reg sine_sign;
    reg cosine_sign;

    // Parts
    rac4i65_core_trigonometry_cosines sines(
        .clock(clock),
        .read_address(sines_read_address),
        .read_data(sines_read_data)
    );
    rac4i65_core_trigonometry_cosines cosines(
        .clock(clock),
        .read_address(cosines_read_address),
        .read_data(cosines_read_data)
    );
    rac4i65_core_dff_28 held (.d(held_d), .q(held_q), .clock(clock));

    always @(*) begin
        held_d = held_q;
        if (load) begin
            held_d = angle[(32'h4)+:(28)];
        end
    end

    always @(*) begin
        quadrant = held_q[(32'h1a)+:(2)];
        index = held_q[(32'h12)+:(8)];
        fraction = held_q[(32'h0)+:(18)] ^ middle;
    end

    always @(*) begin
        sines_read_address = index;
        cosines_read_address = ~index;
        if (quadrant[32'h0]) begin
            sines_read_address = ~index;
            cosines_read_address = index;
        end
    end

    always @(*) begin
        sine_entry = sines_read_data;
        if (sine_sign) begin
            sine_entry = ~sines_read_data;
        end
    end

    always @(*) begin
        sine_sign = quadrant[32'h1];
        cosine_sign = quadrant[32'h1] ^ quadrant[32'h0];
    end

    always @(*) sine = (((sine_entry) & 18'h3ffff) << 32'h1) | (((sine_sign) & 18'h3ffff) << 32'h11) | odd;

    always @(*) begin
        cosine_entry = cosines_read_data;
        if (cosine_sign) begin
            cosine_entry = ~cosines_read_data;
        end
    end

    always @(*) cosine = (((cosine_entry) & 18'h3ffff) << 32'h1) | (((cosine_sign) & 18'h3ffff) << 32'h11) | odd;
endmodule

module rac4i65_core_trigonometry_cosines (
    input wire clock,
    input wire [7:0] read_address,
    output reg [15:0] read_data
);

    (* no_rw_check *)
    reg [15:0] mem [0:255];

    initial begin
        read_data = 16'h0;
        mem[0] = 16'hc9;
        mem[1] = 16'h25b;
        mem[2] = 16'h3ed;
        mem[3] = 16'h57f;
        mem[4] = 16'h711;
        mem[5] = 16'h8a3;
        mem[6] = 16'ha35;
        mem[7] = 16'hbc6;
        mem[8] = 16'hd58;
        mem[9] = 16'heea;
        mem[10] = 16'h107b;
        mem[11] = 16'h120c;
        mem[12] = 16'h139d;
        mem[13] = 16'h152e;
        mem[14] = 16'h16bf;
        mem[15] = 16'h184f;
        mem[16] = 16'h19df;
        mem[17] = 16'h1b6f;
        mem[18] = 16'h1cff;
        mem[19] = 16'h1e8e;
        mem[20] = 16'h201d;
        mem[21] = 16'h21ac;
        mem[22] = 16'h233b;
        mem[23] = 16'h24c9;
        mem[24] = 16'h2656;
        mem[25] = 16'h27e4;
        mem[26] = 16'h2971;
        mem[27] = 16'h2afe;
        mem[28] = 16'h2c8a;
        mem[29] = 16'h2e15;
        mem[30] = 16'h2fa1;
        mem[31] = 16'h312c;
        mem[32] = 16'h32b6;
        mem[33] = 16'h3440;
        mem[34] = 16'h35c9;
        mem[35] = 16'h3752;
        mem[36] = 16'h38db;
        mem[37] = 16'h3a62;
        mem[38] = 16'h3bea;
        mem[39] = 16'h3d70;
        mem[40] = 16'h3ef6;
        mem[41] = 16'h407c;
        mem[42] = 16'h4201;
        mem[43] = 16'h4385;
        mem[44] = 16'h4508;
        mem[45] = 16'h468b;
        mem[46] = 16'h480e;
        mem[47] = 16'h498f;
        mem[48] = 16'h4b10;
        mem[49] = 16'h4c90;
        mem[50] = 16'h4e0f;
        mem[51] = 16'h4f8e;
        mem[52] = 16'h510c;
        mem[53] = 16'h5289;
        mem[54] = 16'h5405;
        mem[55] = 16'h5581;
        mem[56] = 16'h56fb;
        mem[57] = 16'h5875;
        mem[58] = 16'h59ee;
        mem[59] = 16'h5b66;
        mem[60] = 16'h5cdd;
        mem[61] = 16'h5e53;
        mem[62] = 16'h5fc9;
        mem[63] = 16'h613d;
        mem[64] = 16'h62b1;
        mem[65] = 16'h6423;
        mem[66] = 16'h6595;
        mem[67] = 16'h6705;
        mem[68] = 16'h6875;
        mem[69] = 16'h69e4;
        mem[70] = 16'h6b51;
        mem[71] = 16'h6cbe;
        mem[72] = 16'h6e29;
        mem[73] = 16'h6f94;
        mem[74] = 16'h70fd;
        mem[75] = 16'h7265;
        mem[76] = 16'h73cd;
        mem[77] = 16'h7533;
        mem[78] = 16'h7698;
        mem[79] = 16'h77fb;
        mem[80] = 16'h795e;
        mem[81] = 16'h7ac0;
        mem[82] = 16'h7c20;
        mem[83] = 16'h7d7f;
        mem[84] = 16'h7edd;
        mem[85] = 16'h803a;
        mem[86] = 16'h8195;
        mem[87] = 16'h82ef;
        mem[88] = 16'h8448;
        mem[89] = 16'h85a0;
        mem[90] = 16'h86f6;
        mem[91] = 16'h884b;
        mem[92] = 16'h899f;
        mem[93] = 16'h8af1;
        mem[94] = 16'h8c42;
        mem[95] = 16'h8d92;
        mem[96] = 16'h8ee0;
        mem[97] = 16'h902d;
        mem[98] = 16'h9179;
        mem[99] = 16'h92c3;
        mem[100] = 16'h940c;
        mem[101] = 16'h9553;
        mem[102] = 16'h9699;
        mem[103] = 16'h97de;
        mem[104] = 16'h9921;
        mem[105] = 16'h9a62;
        mem[106] = 16'h9ba2;
        mem[107] = 16'h9ce1;
        mem[108] = 16'h9e1e;
        mem[109] = 16'h9f59;
        mem[110] = 16'ha093;
        mem[111] = 16'ha1cb;
        mem[112] = 16'ha302;
        mem[113] = 16'ha438;
        mem[114] = 16'ha56b;
        mem[115] = 16'ha69d;
        mem[116] = 16'ha7ce;
        mem[117] = 16'ha8fd;
        mem[118] = 16'haa2a;
        mem[119] = 16'hab56;
        mem[120] = 16'hac80;
        mem[121] = 16'hada8;
        mem[122] = 16'haece;
        mem[123] = 16'haff3;
        mem[124] = 16'hb117;
        mem[125] = 16'hb238;
        mem[126] = 16'hb358;
        mem[127] = 16'hb476;
        mem[128] = 16'hb592;
        mem[129] = 16'hb6ad;
        mem[130] = 16'hb7c6;
        mem[131] = 16'hb8dd;
        mem[132] = 16'hb9f2;
        mem[133] = 16'hbb06;
        mem[134] = 16'hbc17;
        mem[135] = 16'hbd27;
        mem[136] = 16'hbe35;
        mem[137] = 16'hbf41;
        mem[138] = 16'hc04c;
        mem[139] = 16'hc154;
        mem[140] = 16'hc25b;
        mem[141] = 16'hc360;
        mem[142] = 16'hc463;
        mem[143] = 16'hc564;
        mem[144] = 16'hc663;
        mem[145] = 16'hc760;
        mem[146] = 16'hc85b;
        mem[147] = 16'hc955;
        mem[148] = 16'hca4c;
        mem[149] = 16'hcb41;
        mem[150] = 16'hcc35;
        mem[151] = 16'hcd26;
        mem[152] = 16'hce16;
        mem[153] = 16'hcf04;
        mem[154] = 16'hcfef;
        mem[155] = 16'hd0d9;
        mem[156] = 16'hd1c0;
        mem[157] = 16'hd2a6;
        mem[158] = 16'hd389;
        mem[159] = 16'hd46b;
        mem[160] = 16'hd54a;
        mem[161] = 16'hd627;
        mem[162] = 16'hd703;
        mem[163] = 16'hd7dc;
        mem[164] = 16'hd8b3;
        mem[165] = 16'hd988;
        mem[166] = 16'hda5b;
        mem[167] = 16'hdb2c;
        mem[168] = 16'hdbfb;
        mem[169] = 16'hdcc7;
        mem[170] = 16'hdd92;
        mem[171] = 16'hde5a;
        mem[172] = 16'hdf20;
        mem[173] = 16'hdfe4;
        mem[174] = 16'he0a6;
        mem[175] = 16'he166;
        mem[176] = 16'he224;
        mem[177] = 16'he2df;
        mem[178] = 16'he398;
        mem[179] = 16'he44f;
        mem[180] = 16'he504;
        mem[181] = 16'he5b7;
        mem[182] = 16'he667;
        mem[183] = 16'he715;
        mem[184] = 16'he7c1;
        mem[185] = 16'he86b;
        mem[186] = 16'he912;
        mem[187] = 16'he9b7;
        mem[188] = 16'hea5a;
        mem[189] = 16'heafb;
        mem[190] = 16'heb99;
        mem[191] = 16'hec36;
        mem[192] = 16'hecd0;
        mem[193] = 16'hed67;
        mem[194] = 16'hedfc;
        mem[195] = 16'hee8f;
        mem[196] = 16'hef20;
        mem[197] = 16'hefaf;
        mem[198] = 16'hf03b;
        mem[199] = 16'hf0c5;
        mem[200] = 16'hf14c;
        mem[201] = 16'hf1d1;
        mem[202] = 16'hf254;
        mem[203] = 16'hf2d4;
        mem[204] = 16'hf353;
        mem[205] = 16'hf3ce;
        mem[206] = 16'hf448;
        mem[207] = 16'hf4bf;
        mem[208] = 16'hf534;
        mem[209] = 16'hf5a6;
        mem[210] = 16'hf616;
        mem[211] = 16'hf684;
        mem[212] = 16'hf6ef;
        mem[213] = 16'hf758;
        mem[214] = 16'hf7be;
        mem[215] = 16'hf822;
        mem[216] = 16'hf884;
        mem[217] = 16'hf8e3;
        mem[218] = 16'hf940;
        mem[219] = 16'hf99b;
        mem[220] = 16'hf9f3;
        mem[221] = 16'hfa49;
        mem[222] = 16'hfa9c;
        mem[223] = 16'hfaed;
        mem[224] = 16'hfb3b;
        mem[225] = 16'hfb87;
        mem[226] = 16'hfbd1;
        mem[227] = 16'hfc18;
        mem[228] = 16'hfc5d;
        mem[229] = 16'hfc9f;
        mem[230] = 16'hfcdf;
        mem[231] = 16'hfd1c;
        mem[232] = 16'hfd57;
        mem[233] = 16'hfd90;
        mem[234] = 16'hfdc6;
        mem[235] = 16'hfdfa;
        mem[236] = 16'hfe2b;
        mem[237] = 16'hfe5a;
        mem[238] = 16'hfe86;
        mem[239] = 16'hfeb0;
        mem[240] = 16'hfed7;
        mem[241] = 16'hfefc;
        mem[242] = 16'hff1f;
        mem[243] = 16'hff3f;
        mem[244] = 16'hff5c;
        mem[245] = 16'hff78;
        mem[246] = 16'hff90;
        mem[247] = 16'hffa6;
        mem[248] = 16'hffba;
        mem[249] = 16'hffcb;
        mem[250] = 16'hffda;
        mem[251] = 16'hffe7;
        mem[252] = 16'hfff0;
        mem[253] = 16'hfff8;
        mem[254] = 16'hfffd;
        mem[255] = 16'hffff;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
    end
endmodule

module rac4i65_core_interrupt (
    input wire clock,
    input wire done,
    input wire armed,
    input wire [1:0] enable,
    input wire [1:0] clear,
    output reg int_n,
    output reg [1:0] status
);

    // Pins of the parts
    reg was_armed_d;
    wire was_armed_q;

    reg [1:0] causes_d;
    wire [1:0] causes_q;

    reg low_d;
    wire low_q;

    // Intermediate values
    reg disarms;
    reg [1:0] events;

    // Parts
    rac4i65_core_dff_1 was_armed (.d(was_armed_d), .q(was_armed_q), .clock(clock));
    rac4i65_core_dff_2 causes (.d(causes_d), .q(causes_q), .clock(clock));
    rac4i65_core_dff_1 low (.d(low_d), .q(low_q), .clock(clock));

    always @(*) begin
        was_armed_d = was_armed_q;
        was_armed_d = armed;
    end

    always @(*) begin
        causes_d = causes_q;
        causes_d = (causes_q & ~clear) | events;
    end

    always @(*) begin
        low_d = low_q;
        low_d = |(causes_q & enable);
    end

    always @(*) disarms = was_armed_q & ~armed;
    always @(*) events = ((done) & 2'h3) | (((disarms) & 2'h3) << 32'h1);
    always @(*) int_n = ~low_q;
    always @(*) status = causes_q;
endmodule

module rac4i65_core_radio (
    input wire clock,
    input wire rx,
    input wire host_select,
    input wire [3:0] robot,
    input wire armed,
    input wire taken,
    input wire select_write,
    input wire select,
    output reg offer,
    output reg [13:0] address,
    output reg [31:0] data,
    output reg selected,
    output reg [7:0] accepted,
    output reg [7:0] dropped
);

    // Constants
    localparam gap = 5'b10100;
    localparam no_quiet = 5'b0;
    localparam one_quiet = 5'b1;
    localparam strap_end = 4'hf;
    localparam strap_last = 4'he;
    localparam strap_first = 4'h7;
    localparam one_strap = 4'h1;
    localparam head = 8'ha1;
    localparam no_robot = 4'h0;
    localparam no_byte = 8'h0;
    localparam residue = 32'hdebb20e3;
    localparam at_head = 3'b0;
    localparam at_robot = 3'b1;
    localparam at_length = 3'b10;
    localparam at_sequence = 3'b11;
    localparam at_payload = 3'b100;
    localparam at_crc = 3'b101;
    localparam at_end = 3'b110;
    localparam first_inner = 3'b0;
    localparam one_inner = 3'b1;
    localparam last_of_write = 3'b100;
    localparam last_of_crc = 3'b11;
    localparam all_gathered = 3'b101;
    localparam one_write = 7'b1;
    localparam first_byte = 9'b0;
    localparam one_byte = 9'b1;
    localparam one_frame = 8'h1;
    localparam page_bit_0 = 14'b1000000;
    localparam page_bit_1 = 14'b10000000;
    localparam page_bit_2 = 14'b100000000;

    // Pins of the parts

    reg receiver_enable;
    wire receiver_level;
    wire receiver_hearing;
    wire receiver_bit_time;
    wire receiver_start;
    wire receiver_data_bit;
    wire receiver_byte_done;
    wire receiver_broken;
    wire [7:0] receiver_value;

    wire [31:0] check_state;

    wire [7:0] memory_read_data;

    reg memory_write_enable;
    reg low_1_d;
    wire low_1_q;

    reg low_2_d;
    wire low_2_q;

    reg [3:0] robot_1_d;
    wire [3:0] robot_1_q;

    reg [3:0] robot_number_d;
    wire [3:0] robot_number_q;

    reg [3:0] settling_d;
    wire [3:0] settling_q;

    reg steady_d;
    wire steady_q;

    reg commands_d;
    wire commands_q;

    reg [4:0] quiet_d;
    wire [4:0] quiet_q;

    reg listening_d;
    wire listening_q;

    reg [2:0] stage_d;
    wire [2:0] stage_q;

    reg [2:0] inner_d;
    wire [2:0] inner_q;

    reg [6:0] count_d;
    wire [6:0] count_q;

    reg [6:0] total_d;
    wire [6:0] total_q;

    reg [7:0] number_d;
    wire [7:0] number_q;

    reg [7:0] last_number_d;
    wire [7:0] last_number_q;

    reg [8:0] pointer_d;
    wire [8:0] pointer_q;

    reg playing_d;
    wire playing_q;

    reg offering_d;
    wire offering_q;

    reg [7:0] code_d;
    wire [7:0] code_q;

    reg [31:0] word_d;
    wire [31:0] word_q;

    reg [7:0] accepted_count_d;
    wire [7:0] accepted_count_q;

    reg [7:0] dropped_count_d;
    wire [7:0] dropped_count_q;

    reg [7:0] ahead_d;
    wire [7:0] ahead_q;

    reg check_right_d;
    wire check_right_q;

    // Intermediate values
    reg settled;
    reg silent;
    reg boundary;
    reg fresh;
    reg whole;
    reg accepts;
    reg refuses;
    reg heard;
    reg [7:0] value;
    reg length_fits;
    reg last_write;
    reg [13:0] page;
    reg high_page;

    // Parts
    rac4i65_core_radio_receiver receiver(
        .clock(clock),
        .rx(rx),
        .enable(receiver_enable),
        .level(receiver_level),
        .hearing(receiver_hearing),
        .bit_time(receiver_bit_time),
        .start(receiver_start),
        .data_bit(receiver_data_bit),
        .byte_done(receiver_byte_done),
        .broken(receiver_broken),
        .value(receiver_value)
    );
    rac4i65_core_radio_check check(
        .clock(clock),
        .clear(silent),
        .shift(receiver_data_bit),
        .line(receiver_level),
        .state(check_state)
    );
    rac4i65_core_radio_memory memory(
        .clock(clock),
        .read_address(pointer_q),
        .read_data(memory_read_data),
        .write_address(pointer_q),
        .write_data(value),
        .write_enable(memory_write_enable)
    );
    rac4i65_core_dff_1 low_1 (.d(low_1_d), .q(low_1_q), .clock(clock));
    rac4i65_core_dff_1 low_2 (.d(low_2_d), .q(low_2_q), .clock(clock));
    rac4i65_core_dff_4 robot_1 (.d(robot_1_d), .q(robot_1_q), .clock(clock));
    rac4i65_core_dff_4 robot_number (.d(robot_number_d), .q(robot_number_q), .clock(clock));
    rac4i65_core_dff_4 settling (.d(settling_d), .q(settling_q), .clock(clock));
    rac4i65_core_dff_1 steady (.d(steady_d), .q(steady_q), .clock(clock));
    rac4i65_core_dff_1 commands (.d(commands_d), .q(commands_q), .clock(clock));
    rac4i65_core_dff_5 quiet (.d(quiet_d), .q(quiet_q), .clock(clock));
    rac4i65_core_dff_1 listening (.d(listening_d), .q(listening_q), .clock(clock));
    rac4i65_core_dff_3 stage (.d(stage_d), .q(stage_q), .clock(clock));
    rac4i65_core_dff_3 inner (.d(inner_d), .q(inner_q), .clock(clock));
    rac4i65_core_dff_7 count (.d(count_d), .q(count_q), .clock(clock));
    rac4i65_core_dff_7 total (.d(total_d), .q(total_q), .clock(clock));
    rac4i65_core_dff_8 number (.d(number_d), .q(number_q), .clock(clock));
    rac4i65_core_dff_8_from_ff last_number (.d(last_number_d), .q(last_number_q), .clock(clock));
    rac4i65_core_dff_9 pointer (.d(pointer_d), .q(pointer_q), .clock(clock));
    rac4i65_core_dff_1 playing (.d(playing_d), .q(playing_q), .clock(clock));
    rac4i65_core_dff_1 offering (.d(offering_d), .q(offering_q), .clock(clock));
    rac4i65_core_dff_8 code (.d(code_d), .q(code_q), .clock(clock));
    rac4i65_core_dff_32 word (.d(word_d), .q(word_q), .clock(clock));
    rac4i65_core_dff_8 accepted_count (.d(accepted_count_d), .q(accepted_count_q), .clock(clock));
    rac4i65_core_dff_8 dropped_count (.d(dropped_count_d), .q(dropped_count_q), .clock(clock));
    rac4i65_core_dff_8 ahead (.d(ahead_d), .q(ahead_q), .clock(clock));
    rac4i65_core_dff_1 check_right (.d(check_right_d), .q(check_right_q), .clock(clock));

    always @(*) begin
        low_1_d = low_1_q;
        low_1_d = ~host_select;
        receiver_enable = 1'b1;
    end

    always @(*) begin
        low_2_d = low_2_q;
        low_2_d = low_1_q;
    end

    always @(*) begin
        robot_1_d = robot_1_q;
        robot_1_d = robot;
    end

    always @(*) begin
        robot_number_d = robot_number_q;
        settling_d = settling_q;
        steady_d = steady_q;
        commands_d = commands_q;
        if (~settled) begin
            settling_d = settling_q + one_strap;
            steady_d = low_2_q & (steady_q | (settling_q == strap_first));
            if (settling_q == strap_last) begin
                commands_d = steady_q & low_2_q;
                robot_number_d = robot_1_q;
            end
        end
        if (select_write & ~armed) begin
            commands_d = select;
        end
    end

    always @(*) begin
        quiet_d = quiet_q;
        if (~receiver_level | receiver_hearing) begin
            quiet_d = no_quiet;
        end
        else if (receiver_bit_time & ~silent) begin
            quiet_d = quiet_q + one_quiet;
        end
    end

    always @(*) begin
        listening_d = listening_q;
        stage_d = stage_q;
        inner_d = inner_q;
        count_d = count_q;
        total_d = total_q;
        number_d = number_q;
        last_number_d = last_number_q;
        pointer_d = pointer_q;
        playing_d = playing_q;
        offering_d = offering_q;
        code_d = code_q;
        word_d = word_q;
        accepted_count_d = accepted_count_q;
        dropped_count_d = dropped_count_q;
        if (playing_q) begin
            if (offering_q) begin
                if (taken) begin
                    offering_d = 1'b0;
                    count_d = count_q + one_write;
                    playing_d = ~last_write;
                end
            end
            else begin
                if (inner_q != first_inner) begin
                    code_d = word_q[(32'h0)+:(8)];
                    word_d = (word_q >> 32'h8) | (((memory_read_data) & 32'hffffffff) << 32'h18);
                end
                if (inner_q == all_gathered) begin
                    inner_d = first_inner;
                    offering_d = 1'b1;
                end
                else begin
                    inner_d = inner_q + one_inner;
                    pointer_d = pointer_q + one_byte;
                end
            end
        end
        memory_write_enable = 1'b0;
        refuses = receiver_broken & listening_q;
        if (heard) begin
            case (stage_q)
                0:
                begin
                    stage_d = at_robot;
                    refuses = value != head;
                end
                1:
                begin
                    stage_d = at_length;
                    if ((value[(32'h0)+:(4)] != robot_number_q) | (value[(32'h4)+:(4)] != no_robot)) begin
                        stage_d = at_head;
                        listening_d = 1'b0;
                    end
                end
                2:
                begin
                    stage_d = at_sequence;
                    refuses = ~length_fits;
                    total_d = value[(32'h0)+:(7)];
                    count_d = one_write;
                    pointer_d = first_byte;
                    inner_d = first_inner;
                end
                3:
                begin
                    stage_d = at_payload;
                    number_d = value;
                end
                4:
                begin
                    memory_write_enable = 1'b1;
                    pointer_d = pointer_q + one_byte;
                    inner_d = inner_q + one_inner;
                    if (inner_q == last_of_write) begin
                        inner_d = first_inner;
                        count_d = count_q + one_write;
                        if (last_write) begin
                            stage_d = at_crc;
                        end
                    end
                end
                5:
                begin
                    inner_d = inner_q + one_inner;
                    if (inner_q == last_of_crc) begin
                        stage_d = at_end;
                        inner_d = first_inner;
                    end
                end
                default:
                begin
                    refuses = 1'b1;
                end
            endcase
        end
        accepts = 1'b0;
        if (boundary) begin
            listening_d = 1'b1;
            stage_d = at_head;
            if (listening_q) begin
                accepts = whole & fresh;
                refuses = ~(whole & fresh);
            end
        end
        if (accepts) begin
            accepted_count_d = accepted_count_q + one_frame;
            last_number_d = number_q;
            if (commands_q) begin
                listening_d = 1'b0;
                playing_d = 1'b1;
                count_d = one_write;
                pointer_d = first_byte;
            end
        end
        if (refuses) begin
            dropped_count_d = dropped_count_q + one_frame;
            stage_d = at_head;
            if (~boundary) begin
                listening_d = 1'b0;
            end
        end
    end

    always @(*) begin
        ahead_d = ahead_q;
        ahead_d = number_q - last_number_q;
    end

    always @(*) begin
        check_right_d = check_right_q;
        check_right_d = check_state == residue;
    end

    always @(*) settled = settling_q == strap_end;
    always @(*) heard = receiver_byte_done & listening_q;
    always @(*) value = receiver_value;
    always @(*) silent = quiet_q == gap;
    always @(*) last_write = count_q == total_q;
    always @(*) length_fits = (value != no_byte) & ~value[32'h7] & ~(value[32'h6] & value[32'h5]);
    always @(*) boundary = silent & ~playing_q & (~listening_q | (stage_q != at_head));
    always @(*) fresh = (ahead_q != no_byte) & ~(armed & ahead_q[32'h7]);
    always @(*) whole = (stage_q == at_end) & check_right_q;

    always @(*) begin
        page = ((code_q[(32'h0)+:(6)]) & 14'h3fff);
        high_page = code_q[32'h6] | code_q[32'h7];
    end

    always @(*) begin
        address = page;
        if (high_page) begin
            address = page | page_bit_2;
            if (code_q[32'h7]) begin
                address = page | page_bit_2 | page_bit_1;
                if (code_q[32'h6]) begin
                    address = page | page_bit_2 | page_bit_1 | page_bit_0;
                end
            end
        end
    end

    always @(*) offer = offering_q;
    always @(*) data = word_q;
    always @(*) selected = commands_q;
    always @(*) accepted = accepted_count_q;
    always @(*) dropped = dropped_count_q;
endmodule

module rac4i65_core_radio_receiver (
    input wire clock,
    input wire rx,
    input wire enable,
    output reg level,
    output reg hearing,
    output reg bit_time,
    output reg start,
    output reg data_bit,
    output reg byte_done,
    output reg broken,
    output reg [7:0] value
);

    // Constants
    localparam half_bit = 9'b10001111;
    localparam whole_bit = 9'b100100000;
    localparam no_clocks = 9'b0;
    localparam one_clock = 9'b1;
    localparam no_bits = 4'h0;
    localparam one_bit = 4'h1;
    localparam stop_bit = 4'h9;
    localparam top_bit = 8'h80;

    // Pins of the parts
    reg low_1_d;
    wire low_1_q;

    reg low_2_d;
    wire low_2_q;

    reg hears_d;
    wire hears_q;

    reg [8:0] clocks_d;
    wire [8:0] clocks_q;

    reg [3:0] bits_d;
    wire [3:0] bits_q;

    reg [7:0] shift_d;
    wire [7:0] shift_q;

    // Intermediate values
    reg high;
    reg due;
    reg sampling;
    reg starts;
    reg first;
    reg stop;

    // Parts
    rac4i65_core_dff_1 low_1 (.d(low_1_d), .q(low_1_q), .clock(clock));
    rac4i65_core_dff_1 low_2 (.d(low_2_d), .q(low_2_q), .clock(clock));
    rac4i65_core_dff_1 hears (.d(hears_d), .q(hears_q), .clock(clock));
    rac4i65_core_dff_9 clocks (.d(clocks_d), .q(clocks_q), .clock(clock));
    rac4i65_core_dff_4 bits (.d(bits_d), .q(bits_q), .clock(clock));
    rac4i65_core_dff_8 shift (.d(shift_d), .q(shift_q), .clock(clock));

    always @(*) begin
        low_1_d = low_1_q;
        low_1_d = ~rx;
    end

    always @(*) begin
        low_2_d = low_2_q;
        low_2_d = low_1_q;
    end

    always @(*) begin
        hears_d = hears_q;
        clocks_d = clocks_q;
        bits_d = bits_q;
        shift_d = shift_q;
        clocks_d = clocks_q - one_clock;
        if (due) begin
            clocks_d = whole_bit;
        end
        if (sampling) begin
            bits_d = bits_q + one_bit;
            if (first) begin
                hears_d = low_2_q;
            end
            else if (stop) begin
                hears_d = 1'b0;
            end
            else begin
                shift_d = shift_q >> 32'h1;
                if (high) begin
                    shift_d = (shift_q >> 32'h1) | top_bit;
                end
            end
        end
        if (starts) begin
            hears_d = 1'b1;
            clocks_d = half_bit;
            bits_d = no_bits;
        end
    end

    always @(*) high = ~low_2_q;
    always @(*) starts = low_2_q & enable & ~hears_q;
    always @(*) due = clocks_q == no_clocks;
    always @(*) sampling = hears_q & due;

    always @(*) begin
        first = bits_q == no_bits;
        stop = bits_q == stop_bit;
    end

    always @(*) bit_time = due;
    always @(*) level = high;
    always @(*) hearing = hears_q;
    always @(*) start = starts;
    always @(*) data_bit = sampling & ~first & ~stop;
    always @(*) byte_done = sampling & stop & high;
    always @(*) broken = sampling & stop & low_2_q;
    always @(*) value = shift_q;
endmodule

module rac4i65_core_radio_check (
    input wire clock,
    input wire clear,
    input wire shift,
    input wire line,
    output reg [31:0] state
);

    // Constants
    localparam taps = 32'hedb88320;
    localparam zero = 32'h0;

    // Pins of the parts
    reg [31:0] register_d;
    wire [31:0] register_q;

    // Intermediate values
    reg feedback;

    // Parts
    rac4i65_core_dff_32 register (.d(register_d), .q(register_q), .clock(clock));

    always @(*) begin
        register_d = register_q;
        if (shift) begin
            register_d = register_q >> 32'h1;
            if (feedback) begin
                register_d = (register_q >> 32'h1) ^ taps;
            end
        end
        if (clear) begin
            register_d = ~zero;
        end
    end

    always @(*) feedback = register_q[32'h0] ^ line;
    always @(*) state = register_q;
endmodule

module rac4i65_core_radio_memory (
    input wire clock,
    input wire [8:0] read_address,
    output reg [7:0] read_data,
    input wire [8:0] write_address,
    input wire [7:0] write_data,
    input wire write_enable
);

    (* no_rw_check *)
    reg [7:0] mem [0:511];

    initial begin
        read_data = 8'h0;
        mem[0] = 8'h0;
        mem[1] = 8'h0;
        mem[2] = 8'h0;
        mem[3] = 8'h0;
        mem[4] = 8'h0;
        mem[5] = 8'h0;
        mem[6] = 8'h0;
        mem[7] = 8'h0;
        mem[8] = 8'h0;
        mem[9] = 8'h0;
        mem[10] = 8'h0;
        mem[11] = 8'h0;
        mem[12] = 8'h0;
        mem[13] = 8'h0;
        mem[14] = 8'h0;
        mem[15] = 8'h0;
        mem[16] = 8'h0;
        mem[17] = 8'h0;
        mem[18] = 8'h0;
        mem[19] = 8'h0;
        mem[20] = 8'h0;
        mem[21] = 8'h0;
        mem[22] = 8'h0;
        mem[23] = 8'h0;
        mem[24] = 8'h0;
        mem[25] = 8'h0;
        mem[26] = 8'h0;
        mem[27] = 8'h0;
        mem[28] = 8'h0;
        mem[29] = 8'h0;
        mem[30] = 8'h0;
        mem[31] = 8'h0;
        mem[32] = 8'h0;
        mem[33] = 8'h0;
        mem[34] = 8'h0;
        mem[35] = 8'h0;
        mem[36] = 8'h0;
        mem[37] = 8'h0;
        mem[38] = 8'h0;
        mem[39] = 8'h0;
        mem[40] = 8'h0;
        mem[41] = 8'h0;
        mem[42] = 8'h0;
        mem[43] = 8'h0;
        mem[44] = 8'h0;
        mem[45] = 8'h0;
        mem[46] = 8'h0;
        mem[47] = 8'h0;
        mem[48] = 8'h0;
        mem[49] = 8'h0;
        mem[50] = 8'h0;
        mem[51] = 8'h0;
        mem[52] = 8'h0;
        mem[53] = 8'h0;
        mem[54] = 8'h0;
        mem[55] = 8'h0;
        mem[56] = 8'h0;
        mem[57] = 8'h0;
        mem[58] = 8'h0;
        mem[59] = 8'h0;
        mem[60] = 8'h0;
        mem[61] = 8'h0;
        mem[62] = 8'h0;
        mem[63] = 8'h0;
        mem[64] = 8'h0;
        mem[65] = 8'h0;
        mem[66] = 8'h0;
        mem[67] = 8'h0;
        mem[68] = 8'h0;
        mem[69] = 8'h0;
        mem[70] = 8'h0;
        mem[71] = 8'h0;
        mem[72] = 8'h0;
        mem[73] = 8'h0;
        mem[74] = 8'h0;
        mem[75] = 8'h0;
        mem[76] = 8'h0;
        mem[77] = 8'h0;
        mem[78] = 8'h0;
        mem[79] = 8'h0;
        mem[80] = 8'h0;
        mem[81] = 8'h0;
        mem[82] = 8'h0;
        mem[83] = 8'h0;
        mem[84] = 8'h0;
        mem[85] = 8'h0;
        mem[86] = 8'h0;
        mem[87] = 8'h0;
        mem[88] = 8'h0;
        mem[89] = 8'h0;
        mem[90] = 8'h0;
        mem[91] = 8'h0;
        mem[92] = 8'h0;
        mem[93] = 8'h0;
        mem[94] = 8'h0;
        mem[95] = 8'h0;
        mem[96] = 8'h0;
        mem[97] = 8'h0;
        mem[98] = 8'h0;
        mem[99] = 8'h0;
        mem[100] = 8'h0;
        mem[101] = 8'h0;
        mem[102] = 8'h0;
        mem[103] = 8'h0;
        mem[104] = 8'h0;
        mem[105] = 8'h0;
        mem[106] = 8'h0;
        mem[107] = 8'h0;
        mem[108] = 8'h0;
        mem[109] = 8'h0;
        mem[110] = 8'h0;
        mem[111] = 8'h0;
        mem[112] = 8'h0;
        mem[113] = 8'h0;
        mem[114] = 8'h0;
        mem[115] = 8'h0;
        mem[116] = 8'h0;
        mem[117] = 8'h0;
        mem[118] = 8'h0;
        mem[119] = 8'h0;
        mem[120] = 8'h0;
        mem[121] = 8'h0;
        mem[122] = 8'h0;
        mem[123] = 8'h0;
        mem[124] = 8'h0;
        mem[125] = 8'h0;
        mem[126] = 8'h0;
        mem[127] = 8'h0;
        mem[128] = 8'h0;
        mem[129] = 8'h0;
        mem[130] = 8'h0;
        mem[131] = 8'h0;
        mem[132] = 8'h0;
        mem[133] = 8'h0;
        mem[134] = 8'h0;
        mem[135] = 8'h0;
        mem[136] = 8'h0;
        mem[137] = 8'h0;
        mem[138] = 8'h0;
        mem[139] = 8'h0;
        mem[140] = 8'h0;
        mem[141] = 8'h0;
        mem[142] = 8'h0;
        mem[143] = 8'h0;
        mem[144] = 8'h0;
        mem[145] = 8'h0;
        mem[146] = 8'h0;
        mem[147] = 8'h0;
        mem[148] = 8'h0;
        mem[149] = 8'h0;
        mem[150] = 8'h0;
        mem[151] = 8'h0;
        mem[152] = 8'h0;
        mem[153] = 8'h0;
        mem[154] = 8'h0;
        mem[155] = 8'h0;
        mem[156] = 8'h0;
        mem[157] = 8'h0;
        mem[158] = 8'h0;
        mem[159] = 8'h0;
        mem[160] = 8'h0;
        mem[161] = 8'h0;
        mem[162] = 8'h0;
        mem[163] = 8'h0;
        mem[164] = 8'h0;
        mem[165] = 8'h0;
        mem[166] = 8'h0;
        mem[167] = 8'h0;
        mem[168] = 8'h0;
        mem[169] = 8'h0;
        mem[170] = 8'h0;
        mem[171] = 8'h0;
        mem[172] = 8'h0;
        mem[173] = 8'h0;
        mem[174] = 8'h0;
        mem[175] = 8'h0;
        mem[176] = 8'h0;
        mem[177] = 8'h0;
        mem[178] = 8'h0;
        mem[179] = 8'h0;
        mem[180] = 8'h0;
        mem[181] = 8'h0;
        mem[182] = 8'h0;
        mem[183] = 8'h0;
        mem[184] = 8'h0;
        mem[185] = 8'h0;
        mem[186] = 8'h0;
        mem[187] = 8'h0;
        mem[188] = 8'h0;
        mem[189] = 8'h0;
        mem[190] = 8'h0;
        mem[191] = 8'h0;
        mem[192] = 8'h0;
        mem[193] = 8'h0;
        mem[194] = 8'h0;
        mem[195] = 8'h0;
        mem[196] = 8'h0;
        mem[197] = 8'h0;
        mem[198] = 8'h0;
        mem[199] = 8'h0;
        mem[200] = 8'h0;
        mem[201] = 8'h0;
        mem[202] = 8'h0;
        mem[203] = 8'h0;
        mem[204] = 8'h0;
        mem[205] = 8'h0;
        mem[206] = 8'h0;
        mem[207] = 8'h0;
        mem[208] = 8'h0;
        mem[209] = 8'h0;
        mem[210] = 8'h0;
        mem[211] = 8'h0;
        mem[212] = 8'h0;
        mem[213] = 8'h0;
        mem[214] = 8'h0;
        mem[215] = 8'h0;
        mem[216] = 8'h0;
        mem[217] = 8'h0;
        mem[218] = 8'h0;
        mem[219] = 8'h0;
        mem[220] = 8'h0;
        mem[221] = 8'h0;
        mem[222] = 8'h0;
        mem[223] = 8'h0;
        mem[224] = 8'h0;
        mem[225] = 8'h0;
        mem[226] = 8'h0;
        mem[227] = 8'h0;
        mem[228] = 8'h0;
        mem[229] = 8'h0;
        mem[230] = 8'h0;
        mem[231] = 8'h0;
        mem[232] = 8'h0;
        mem[233] = 8'h0;
        mem[234] = 8'h0;
        mem[235] = 8'h0;
        mem[236] = 8'h0;
        mem[237] = 8'h0;
        mem[238] = 8'h0;
        mem[239] = 8'h0;
        mem[240] = 8'h0;
        mem[241] = 8'h0;
        mem[242] = 8'h0;
        mem[243] = 8'h0;
        mem[244] = 8'h0;
        mem[245] = 8'h0;
        mem[246] = 8'h0;
        mem[247] = 8'h0;
        mem[248] = 8'h0;
        mem[249] = 8'h0;
        mem[250] = 8'h0;
        mem[251] = 8'h0;
        mem[252] = 8'h0;
        mem[253] = 8'h0;
        mem[254] = 8'h0;
        mem[255] = 8'h0;
        mem[256] = 8'h0;
        mem[257] = 8'h0;
        mem[258] = 8'h0;
        mem[259] = 8'h0;
        mem[260] = 8'h0;
        mem[261] = 8'h0;
        mem[262] = 8'h0;
        mem[263] = 8'h0;
        mem[264] = 8'h0;
        mem[265] = 8'h0;
        mem[266] = 8'h0;
        mem[267] = 8'h0;
        mem[268] = 8'h0;
        mem[269] = 8'h0;
        mem[270] = 8'h0;
        mem[271] = 8'h0;
        mem[272] = 8'h0;
        mem[273] = 8'h0;
        mem[274] = 8'h0;
        mem[275] = 8'h0;
        mem[276] = 8'h0;
        mem[277] = 8'h0;
        mem[278] = 8'h0;
        mem[279] = 8'h0;
        mem[280] = 8'h0;
        mem[281] = 8'h0;
        mem[282] = 8'h0;
        mem[283] = 8'h0;
        mem[284] = 8'h0;
        mem[285] = 8'h0;
        mem[286] = 8'h0;
        mem[287] = 8'h0;
        mem[288] = 8'h0;
        mem[289] = 8'h0;
        mem[290] = 8'h0;
        mem[291] = 8'h0;
        mem[292] = 8'h0;
        mem[293] = 8'h0;
        mem[294] = 8'h0;
        mem[295] = 8'h0;
        mem[296] = 8'h0;
        mem[297] = 8'h0;
        mem[298] = 8'h0;
        mem[299] = 8'h0;
        mem[300] = 8'h0;
        mem[301] = 8'h0;
        mem[302] = 8'h0;
        mem[303] = 8'h0;
        mem[304] = 8'h0;
        mem[305] = 8'h0;
        mem[306] = 8'h0;
        mem[307] = 8'h0;
        mem[308] = 8'h0;
        mem[309] = 8'h0;
        mem[310] = 8'h0;
        mem[311] = 8'h0;
        mem[312] = 8'h0;
        mem[313] = 8'h0;
        mem[314] = 8'h0;
        mem[315] = 8'h0;
        mem[316] = 8'h0;
        mem[317] = 8'h0;
        mem[318] = 8'h0;
        mem[319] = 8'h0;
        mem[320] = 8'h0;
        mem[321] = 8'h0;
        mem[322] = 8'h0;
        mem[323] = 8'h0;
        mem[324] = 8'h0;
        mem[325] = 8'h0;
        mem[326] = 8'h0;
        mem[327] = 8'h0;
        mem[328] = 8'h0;
        mem[329] = 8'h0;
        mem[330] = 8'h0;
        mem[331] = 8'h0;
        mem[332] = 8'h0;
        mem[333] = 8'h0;
        mem[334] = 8'h0;
        mem[335] = 8'h0;
        mem[336] = 8'h0;
        mem[337] = 8'h0;
        mem[338] = 8'h0;
        mem[339] = 8'h0;
        mem[340] = 8'h0;
        mem[341] = 8'h0;
        mem[342] = 8'h0;
        mem[343] = 8'h0;
        mem[344] = 8'h0;
        mem[345] = 8'h0;
        mem[346] = 8'h0;
        mem[347] = 8'h0;
        mem[348] = 8'h0;
        mem[349] = 8'h0;
        mem[350] = 8'h0;
        mem[351] = 8'h0;
        mem[352] = 8'h0;
        mem[353] = 8'h0;
        mem[354] = 8'h0;
        mem[355] = 8'h0;
        mem[356] = 8'h0;
        mem[357] = 8'h0;
        mem[358] = 8'h0;
        mem[359] = 8'h0;
        mem[360] = 8'h0;
        mem[361] = 8'h0;
        mem[362] = 8'h0;
        mem[363] = 8'h0;
        mem[364] = 8'h0;
        mem[365] = 8'h0;
        mem[366] = 8'h0;
        mem[367] = 8'h0;
        mem[368] = 8'h0;
        mem[369] = 8'h0;
        mem[370] = 8'h0;
        mem[371] = 8'h0;
        mem[372] = 8'h0;
        mem[373] = 8'h0;
        mem[374] = 8'h0;
        mem[375] = 8'h0;
        mem[376] = 8'h0;
        mem[377] = 8'h0;
        mem[378] = 8'h0;
        mem[379] = 8'h0;
        mem[380] = 8'h0;
        mem[381] = 8'h0;
        mem[382] = 8'h0;
        mem[383] = 8'h0;
        mem[384] = 8'h0;
        mem[385] = 8'h0;
        mem[386] = 8'h0;
        mem[387] = 8'h0;
        mem[388] = 8'h0;
        mem[389] = 8'h0;
        mem[390] = 8'h0;
        mem[391] = 8'h0;
        mem[392] = 8'h0;
        mem[393] = 8'h0;
        mem[394] = 8'h0;
        mem[395] = 8'h0;
        mem[396] = 8'h0;
        mem[397] = 8'h0;
        mem[398] = 8'h0;
        mem[399] = 8'h0;
        mem[400] = 8'h0;
        mem[401] = 8'h0;
        mem[402] = 8'h0;
        mem[403] = 8'h0;
        mem[404] = 8'h0;
        mem[405] = 8'h0;
        mem[406] = 8'h0;
        mem[407] = 8'h0;
        mem[408] = 8'h0;
        mem[409] = 8'h0;
        mem[410] = 8'h0;
        mem[411] = 8'h0;
        mem[412] = 8'h0;
        mem[413] = 8'h0;
        mem[414] = 8'h0;
        mem[415] = 8'h0;
        mem[416] = 8'h0;
        mem[417] = 8'h0;
        mem[418] = 8'h0;
        mem[419] = 8'h0;
        mem[420] = 8'h0;
        mem[421] = 8'h0;
        mem[422] = 8'h0;
        mem[423] = 8'h0;
        mem[424] = 8'h0;
        mem[425] = 8'h0;
        mem[426] = 8'h0;
        mem[427] = 8'h0;
        mem[428] = 8'h0;
        mem[429] = 8'h0;
        mem[430] = 8'h0;
        mem[431] = 8'h0;
        mem[432] = 8'h0;
        mem[433] = 8'h0;
        mem[434] = 8'h0;
        mem[435] = 8'h0;
        mem[436] = 8'h0;
        mem[437] = 8'h0;
        mem[438] = 8'h0;
        mem[439] = 8'h0;
        mem[440] = 8'h0;
        mem[441] = 8'h0;
        mem[442] = 8'h0;
        mem[443] = 8'h0;
        mem[444] = 8'h0;
        mem[445] = 8'h0;
        mem[446] = 8'h0;
        mem[447] = 8'h0;
        mem[448] = 8'h0;
        mem[449] = 8'h0;
        mem[450] = 8'h0;
        mem[451] = 8'h0;
        mem[452] = 8'h0;
        mem[453] = 8'h0;
        mem[454] = 8'h0;
        mem[455] = 8'h0;
        mem[456] = 8'h0;
        mem[457] = 8'h0;
        mem[458] = 8'h0;
        mem[459] = 8'h0;
        mem[460] = 8'h0;
        mem[461] = 8'h0;
        mem[462] = 8'h0;
        mem[463] = 8'h0;
        mem[464] = 8'h0;
        mem[465] = 8'h0;
        mem[466] = 8'h0;
        mem[467] = 8'h0;
        mem[468] = 8'h0;
        mem[469] = 8'h0;
        mem[470] = 8'h0;
        mem[471] = 8'h0;
        mem[472] = 8'h0;
        mem[473] = 8'h0;
        mem[474] = 8'h0;
        mem[475] = 8'h0;
        mem[476] = 8'h0;
        mem[477] = 8'h0;
        mem[478] = 8'h0;
        mem[479] = 8'h0;
        mem[480] = 8'h0;
        mem[481] = 8'h0;
        mem[482] = 8'h0;
        mem[483] = 8'h0;
        mem[484] = 8'h0;
        mem[485] = 8'h0;
        mem[486] = 8'h0;
        mem[487] = 8'h0;
        mem[488] = 8'h0;
        mem[489] = 8'h0;
        mem[490] = 8'h0;
        mem[491] = 8'h0;
        mem[492] = 8'h0;
        mem[493] = 8'h0;
        mem[494] = 8'h0;
        mem[495] = 8'h0;
        mem[496] = 8'h0;
        mem[497] = 8'h0;
        mem[498] = 8'h0;
        mem[499] = 8'h0;
        mem[500] = 8'h0;
        mem[501] = 8'h0;
        mem[502] = 8'h0;
        mem[503] = 8'h0;
        mem[504] = 8'h0;
        mem[505] = 8'h0;
        mem[506] = 8'h0;
        mem[507] = 8'h0;
        mem[508] = 8'h0;
        mem[509] = 8'h0;
        mem[510] = 8'h0;
        mem[511] = 8'h0;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
        if (write_enable) mem[write_address] <= write_data;
    end
endmodule

module rac4i65_core_imu (
    input wire clock,
    input wire tick,
    input wire [1:0] bank,
    input wire enable,
    input wire idle_high,
    input wire [1:0] half,
    input wire [6:0] first,
    input wire access,
    input wire [15:0] command,
    input wire miso,
    input wire ready,
    input wire [1:0] read_bank,
    input wire [2:0] read_word,
    output reg cs_n,
    output reg sclk,
    output reg mosi,
    output reg busy,
    output reg reading,
    output reg [7:0] value,
    output reg [15:0] read_data
);

    // Constants
    localparam no_phase = 2'b0;
    localparam one_phase = 2'b1;
    localparam burst_start = 8'he;
    localparam access_start = 8'hde;
    localparam one_half = 8'h1;
    localparam last_high = 8'hfe;
    localparam trail = 8'hff;
    localparam word_end = 5'b11110;
    localparam no_slot = 3'b0;
    localparam read_flag = 16'h8000;
    localparam bit_0 = 16'h1;
    localparam never = 16'h0;
    localparam now = 16'hffff;

    // Pins of the parts

    reg [7:0] words_read_address;
    wire [15:0] words_read_data;
    reg [7:0] words_write_address;
    reg [15:0] words_write_data;
    reg words_write_enable;
    reg live_d;
    wire live_q;

    reg starts_d;
    wire starts_q;

    reg run_d;
    wire run_q;

    reg burst_d;
    wire burst_q;

    reg [7:0] halves_d;
    wire [7:0] halves_q;

    reg [1:0] phase_d;
    wire [1:0] phase_q;

    reg [15:0] shift_d;
    wire [15:0] shift_q;

    reg clock_high_d;
    wire clock_high_q;

    reg mosi_high_d;
    wire mosi_high_q;

    reg ready_1_d;
    wire ready_1_q;

    reg ready_2_d;
    wire ready_2_q;

    reg ready_3_d;
    wire ready_3_q;

    reg [15:0] left_d;
    wire [15:0] left_q;

    // Intermediate values
    reg edge_now;
    reg begins_burst;
    reg begins_access;
    reg low_half;
    reg data_phase;
    reg word_done;
    reg [7:0] place;

    // Parts
    rac4i65_core_imu_words words(
        .clock(clock),
        .read_address(words_read_address),
        .read_data(words_read_data),
        .write_address(words_write_address),
        .write_data(words_write_data),
        .write_enable(words_write_enable)
    );
    rac4i65_core_dff_1 live (.d(live_d), .q(live_q), .clock(clock));
    rac4i65_core_dff_1 starts (.d(starts_d), .q(starts_q), .clock(clock));
    rac4i65_core_dff_1 run (.d(run_d), .q(run_q), .clock(clock));
    rac4i65_core_dff_1 burst (.d(burst_d), .q(burst_q), .clock(clock));
    rac4i65_core_dff_8 halves (.d(halves_d), .q(halves_q), .clock(clock));
    rac4i65_core_dff_2 phase (.d(phase_d), .q(phase_q), .clock(clock));
    rac4i65_core_dff_16 shift (.d(shift_d), .q(shift_q), .clock(clock));
    rac4i65_core_dff_1 clock_high (.d(clock_high_d), .q(clock_high_q), .clock(clock));
    rac4i65_core_dff_1 mosi_high (.d(mosi_high_d), .q(mosi_high_q), .clock(clock));
    rac4i65_core_dff_1 ready_1 (.d(ready_1_d), .q(ready_1_q), .clock(clock));
    rac4i65_core_dff_1 ready_2 (.d(ready_2_d), .q(ready_2_q), .clock(clock));
    rac4i65_core_dff_1 ready_3 (.d(ready_3_d), .q(ready_3_q), .clock(clock));
    rac4i65_core_dff_16 left (.d(left_d), .q(left_q), .clock(clock));

    always @(*) begin
        live_d = live_q;
        live_d = enable & (live_q | ~run_q);
    end

    always @(*) begin
        starts_d = starts_q;
        starts_d = tick;
    end

    always @(*) begin
        run_d = run_q;
        burst_d = burst_q;
        halves_d = halves_q;
        shift_d = shift_q;
        clock_high_d = clock_high_q;
        mosi_high_d = mosi_high_q;
        if (~run_q) begin
            clock_high_d = idle_high;
        end
        if (edge_now) begin
            halves_d = halves_q + one_half;
            if (low_half) begin
                if (halves_q == trail) begin
                    run_d = 1'b0;
                    burst_d = 1'b0;
                end
                else begin
                    clock_high_d = 1'b1;
                    shift_d = shift_q << 32'h1;
                    if (miso) begin
                        shift_d = (shift_q << 32'h1) | bit_0;
                    end
                end
            end
            else begin
                clock_high_d = (halves_q == last_high) & idle_high;
                mosi_high_d = shift_q[32'hf] & ~data_phase;
            end
        end
        if (begins_burst) begin
            run_d = 1'b1;
            burst_d = 1'b1;
            halves_d = burst_start;
            shift_d = (((first) & 16'hffff) << 32'h8) | read_flag;
        end
        if (begins_access) begin
            run_d = 1'b1;
            halves_d = access_start;
            shift_d = command;
        end
    end

    always @(*) begin
        phase_d = phase_q;
        phase_d = no_phase;
        if (run_q & ~edge_now) begin
            phase_d = phase_q + one_phase;
        end
    end

    always @(*) begin
        ready_1_d = ready_1_q;
        ready_1_d = ready;
    end

    always @(*) begin
        ready_2_d = ready_2_q;
        ready_2_d = ready_1_q;
    end

    always @(*) begin
        ready_3_d = ready_3_q;
        ready_3_d = ready_2_q;
    end

    always @(*) begin
        left_d = left_q;
        if (left_q != never) begin
            left_d = left_q - bit_0;
        end
        if (ready_2_q & ~ready_3_q) begin
            left_d = now;
        end
        if (~live_q) begin
            left_d = never;
        end
    end

    always @(*) begins_burst = starts_q & live_q & ~run_q;
    always @(*) begins_access = access & ~enable & ~live_q & ~run_q;
    always @(*) edge_now = run_q & (phase_q == half);
    always @(*) low_half = halves_q[32'h0];
    always @(*) data_phase = burst_q & (halves_q[(32'h5)+:(3)] != no_slot);
    always @(*) word_done = edge_now & data_phase & (halves_q[(32'h0)+:(5)] == word_end);
    always @(*) place = ((bank) & 8'hff) << 32'h3;

    always @(*) begin
        words_write_address = place;
        words_write_data = ~left_q;
        if (~starts_q) begin
            words_write_address = place | ((halves_q[(32'h5)+:(3)]) & 8'hff);
            words_write_data = shift_q;
        end
    end

    always @(*) words_write_enable = starts_q | word_done;
    always @(*) words_read_address = ((read_word) & 8'hff) | (((read_bank) & 8'hff) << 32'h3);
    always @(*) read_data = words_read_data;

    always @(*) begin
        cs_n = ~run_q;
        busy = run_q;
    end

    always @(*) sclk = clock_high_q;
    always @(*) mosi = mosi_high_q;
    always @(*) reading = burst_q;
    always @(*) value = shift_q[(32'h0)+:(8)];
endmodule

module rac4i65_core_imu_words (
    input wire clock,
    input wire [7:0] read_address,
    output reg [15:0] read_data,
    input wire [7:0] write_address,
    input wire [15:0] write_data,
    input wire write_enable
);

    (* no_rw_check *)
    reg [15:0] mem [0:255];

    initial begin
        read_data = 16'h0;
        mem[0] = 16'h0;
        mem[1] = 16'h0;
        mem[2] = 16'h0;
        mem[3] = 16'h0;
        mem[4] = 16'h0;
        mem[5] = 16'h0;
        mem[6] = 16'h0;
        mem[7] = 16'h0;
        mem[8] = 16'h0;
        mem[9] = 16'h0;
        mem[10] = 16'h0;
        mem[11] = 16'h0;
        mem[12] = 16'h0;
        mem[13] = 16'h0;
        mem[14] = 16'h0;
        mem[15] = 16'h0;
        mem[16] = 16'h0;
        mem[17] = 16'h0;
        mem[18] = 16'h0;
        mem[19] = 16'h0;
        mem[20] = 16'h0;
        mem[21] = 16'h0;
        mem[22] = 16'h0;
        mem[23] = 16'h0;
        mem[24] = 16'h0;
        mem[25] = 16'h0;
        mem[26] = 16'h0;
        mem[27] = 16'h0;
        mem[28] = 16'h0;
        mem[29] = 16'h0;
        mem[30] = 16'h0;
        mem[31] = 16'h0;
        mem[32] = 16'h0;
        mem[33] = 16'h0;
        mem[34] = 16'h0;
        mem[35] = 16'h0;
        mem[36] = 16'h0;
        mem[37] = 16'h0;
        mem[38] = 16'h0;
        mem[39] = 16'h0;
        mem[40] = 16'h0;
        mem[41] = 16'h0;
        mem[42] = 16'h0;
        mem[43] = 16'h0;
        mem[44] = 16'h0;
        mem[45] = 16'h0;
        mem[46] = 16'h0;
        mem[47] = 16'h0;
        mem[48] = 16'h0;
        mem[49] = 16'h0;
        mem[50] = 16'h0;
        mem[51] = 16'h0;
        mem[52] = 16'h0;
        mem[53] = 16'h0;
        mem[54] = 16'h0;
        mem[55] = 16'h0;
        mem[56] = 16'h0;
        mem[57] = 16'h0;
        mem[58] = 16'h0;
        mem[59] = 16'h0;
        mem[60] = 16'h0;
        mem[61] = 16'h0;
        mem[62] = 16'h0;
        mem[63] = 16'h0;
        mem[64] = 16'h0;
        mem[65] = 16'h0;
        mem[66] = 16'h0;
        mem[67] = 16'h0;
        mem[68] = 16'h0;
        mem[69] = 16'h0;
        mem[70] = 16'h0;
        mem[71] = 16'h0;
        mem[72] = 16'h0;
        mem[73] = 16'h0;
        mem[74] = 16'h0;
        mem[75] = 16'h0;
        mem[76] = 16'h0;
        mem[77] = 16'h0;
        mem[78] = 16'h0;
        mem[79] = 16'h0;
        mem[80] = 16'h0;
        mem[81] = 16'h0;
        mem[82] = 16'h0;
        mem[83] = 16'h0;
        mem[84] = 16'h0;
        mem[85] = 16'h0;
        mem[86] = 16'h0;
        mem[87] = 16'h0;
        mem[88] = 16'h0;
        mem[89] = 16'h0;
        mem[90] = 16'h0;
        mem[91] = 16'h0;
        mem[92] = 16'h0;
        mem[93] = 16'h0;
        mem[94] = 16'h0;
        mem[95] = 16'h0;
        mem[96] = 16'h0;
        mem[97] = 16'h0;
        mem[98] = 16'h0;
        mem[99] = 16'h0;
        mem[100] = 16'h0;
        mem[101] = 16'h0;
        mem[102] = 16'h0;
        mem[103] = 16'h0;
        mem[104] = 16'h0;
        mem[105] = 16'h0;
        mem[106] = 16'h0;
        mem[107] = 16'h0;
        mem[108] = 16'h0;
        mem[109] = 16'h0;
        mem[110] = 16'h0;
        mem[111] = 16'h0;
        mem[112] = 16'h0;
        mem[113] = 16'h0;
        mem[114] = 16'h0;
        mem[115] = 16'h0;
        mem[116] = 16'h0;
        mem[117] = 16'h0;
        mem[118] = 16'h0;
        mem[119] = 16'h0;
        mem[120] = 16'h0;
        mem[121] = 16'h0;
        mem[122] = 16'h0;
        mem[123] = 16'h0;
        mem[124] = 16'h0;
        mem[125] = 16'h0;
        mem[126] = 16'h0;
        mem[127] = 16'h0;
        mem[128] = 16'h0;
        mem[129] = 16'h0;
        mem[130] = 16'h0;
        mem[131] = 16'h0;
        mem[132] = 16'h0;
        mem[133] = 16'h0;
        mem[134] = 16'h0;
        mem[135] = 16'h0;
        mem[136] = 16'h0;
        mem[137] = 16'h0;
        mem[138] = 16'h0;
        mem[139] = 16'h0;
        mem[140] = 16'h0;
        mem[141] = 16'h0;
        mem[142] = 16'h0;
        mem[143] = 16'h0;
        mem[144] = 16'h0;
        mem[145] = 16'h0;
        mem[146] = 16'h0;
        mem[147] = 16'h0;
        mem[148] = 16'h0;
        mem[149] = 16'h0;
        mem[150] = 16'h0;
        mem[151] = 16'h0;
        mem[152] = 16'h0;
        mem[153] = 16'h0;
        mem[154] = 16'h0;
        mem[155] = 16'h0;
        mem[156] = 16'h0;
        mem[157] = 16'h0;
        mem[158] = 16'h0;
        mem[159] = 16'h0;
        mem[160] = 16'h0;
        mem[161] = 16'h0;
        mem[162] = 16'h0;
        mem[163] = 16'h0;
        mem[164] = 16'h0;
        mem[165] = 16'h0;
        mem[166] = 16'h0;
        mem[167] = 16'h0;
        mem[168] = 16'h0;
        mem[169] = 16'h0;
        mem[170] = 16'h0;
        mem[171] = 16'h0;
        mem[172] = 16'h0;
        mem[173] = 16'h0;
        mem[174] = 16'h0;
        mem[175] = 16'h0;
        mem[176] = 16'h0;
        mem[177] = 16'h0;
        mem[178] = 16'h0;
        mem[179] = 16'h0;
        mem[180] = 16'h0;
        mem[181] = 16'h0;
        mem[182] = 16'h0;
        mem[183] = 16'h0;
        mem[184] = 16'h0;
        mem[185] = 16'h0;
        mem[186] = 16'h0;
        mem[187] = 16'h0;
        mem[188] = 16'h0;
        mem[189] = 16'h0;
        mem[190] = 16'h0;
        mem[191] = 16'h0;
        mem[192] = 16'h0;
        mem[193] = 16'h0;
        mem[194] = 16'h0;
        mem[195] = 16'h0;
        mem[196] = 16'h0;
        mem[197] = 16'h0;
        mem[198] = 16'h0;
        mem[199] = 16'h0;
        mem[200] = 16'h0;
        mem[201] = 16'h0;
        mem[202] = 16'h0;
        mem[203] = 16'h0;
        mem[204] = 16'h0;
        mem[205] = 16'h0;
        mem[206] = 16'h0;
        mem[207] = 16'h0;
        mem[208] = 16'h0;
        mem[209] = 16'h0;
        mem[210] = 16'h0;
        mem[211] = 16'h0;
        mem[212] = 16'h0;
        mem[213] = 16'h0;
        mem[214] = 16'h0;
        mem[215] = 16'h0;
        mem[216] = 16'h0;
        mem[217] = 16'h0;
        mem[218] = 16'h0;
        mem[219] = 16'h0;
        mem[220] = 16'h0;
        mem[221] = 16'h0;
        mem[222] = 16'h0;
        mem[223] = 16'h0;
        mem[224] = 16'h0;
        mem[225] = 16'h0;
        mem[226] = 16'h0;
        mem[227] = 16'h0;
        mem[228] = 16'h0;
        mem[229] = 16'h0;
        mem[230] = 16'h0;
        mem[231] = 16'h0;
        mem[232] = 16'h0;
        mem[233] = 16'h0;
        mem[234] = 16'h0;
        mem[235] = 16'h0;
        mem[236] = 16'h0;
        mem[237] = 16'h0;
        mem[238] = 16'h0;
        mem[239] = 16'h0;
        mem[240] = 16'h0;
        mem[241] = 16'h0;
        mem[242] = 16'h0;
        mem[243] = 16'h0;
        mem[244] = 16'h0;
        mem[245] = 16'h0;
        mem[246] = 16'h0;
        mem[247] = 16'h0;
        mem[248] = 16'h0;
        mem[249] = 16'h0;
        mem[250] = 16'h0;
        mem[251] = 16'h0;
        mem[252] = 16'h0;
        mem[253] = 16'h0;
        mem[254] = 16'h0;
        mem[255] = 16'h0;
    end

    always @(posedge clock) begin
        read_data <= mem[read_address];
        if (write_enable) mem[write_address] <= write_data;
    end
endmodule

module rac4i65_core_encoders (
    input wire clock,
    input wire a,
    input wire b,
    input wire [3:0] filter,
    input wire sample,
    input wire [23:0] now,
    input wire clear_error,
    input wire index,
    input wire arm_index,
    output reg [15:0] count,
    output reg [23:0] edge_time,
    output reg direction,
    output reg error,
    output reg live_a,
    output reg live_b,
    output reg step,
    output reg up,
    output reg live_index,
    output reg [15:0] index_count,
    output reg index_event,
    output reg index_waiting,
    output reg index_seen
);

    // Constants
    localparam forward = 16'h1;
    localparam backward = 16'hffff;

    // Pins of the parts

    reg line_a_tick;

    reg line_a_load;
    wire line_a_synchronised;
    wire line_a_value;

    reg line_b_tick;

    reg line_b_load;
    wire line_b_synchronised;
    wire line_b_value;

    reg line_index_tick;

    reg line_index_load;
    wire line_index_synchronised;
    wire line_index_value;
    reg last_index_d;
    wire last_index_q;

    reg [15:0] captured_d;
    wire [15:0] captured_q;

    reg waiting_d;
    wire waiting_q;

    reg seen_d;
    wire seen_q;

    reg fresh_d;
    wire fresh_q;

    reg sampled_event_d;
    wire sampled_event_q;

    reg [15:0] sampled_capture_d;
    wire [15:0] sampled_capture_q;

    reg settled_0_d;
    wire settled_0_q;

    reg settled_1_d;
    wire settled_1_q;

    reg settled_d;
    wire settled_q;

    reg last_a_d;
    wire last_a_q;

    reg last_b_d;
    wire last_b_q;

    reg [15:0] live_count_d;
    wire [15:0] live_count_q;

    reg [23:0] live_time_d;
    wire [23:0] live_time_q;

    reg live_direction_d;
    wire live_direction_q;

    reg [15:0] sampled_count_d;
    wire [15:0] sampled_count_q;

    reg [23:0] sampled_time_d;
    wire [23:0] sampled_time_q;

    reg sampled_direction_d;
    wire sampled_direction_q;

    reg sticky_error_d;
    wire sticky_error_q;

    // Intermediate values
    reg captures;
    reg change_a;
    reg change_b;
    reg counts;
    reg upward;
    reg [15:0] change;

    // Parts
    rac4i65_core_encoders_line_a line_a(
        .clock(clock),
        .pin(a),
        .tick(line_a_tick),
        .limit(filter),
        .load(line_a_load),
        .synchronised(line_a_synchronised),
        .value(line_a_value)
    );
    rac4i65_core_encoders_line_a line_b(
        .clock(clock),
        .pin(b),
        .tick(line_b_tick),
        .limit(filter),
        .load(line_b_load),
        .synchronised(line_b_synchronised),
        .value(line_b_value)
    );
    rac4i65_core_encoders_line_a line_index(
        .clock(clock),
        .pin(index),
        .tick(line_index_tick),
        .limit(filter),
        .load(line_index_load),
        .synchronised(line_index_synchronised),
        .value(line_index_value)
    );
    rac4i65_core_dff_1 last_index (.d(last_index_d), .q(last_index_q), .clock(clock));
    rac4i65_core_dff_16 captured (.d(captured_d), .q(captured_q), .clock(clock));
    rac4i65_core_dff_1 waiting (.d(waiting_d), .q(waiting_q), .clock(clock));
    rac4i65_core_dff_1 seen (.d(seen_d), .q(seen_q), .clock(clock));
    rac4i65_core_dff_1 fresh (.d(fresh_d), .q(fresh_q), .clock(clock));
    rac4i65_core_dff_1 sampled_event (.d(sampled_event_d), .q(sampled_event_q), .clock(clock));
    rac4i65_core_dff_16 sampled_capture (.d(sampled_capture_d), .q(sampled_capture_q), .clock(clock));
    rac4i65_core_dff_1 settled_0 (.d(settled_0_d), .q(settled_0_q), .clock(clock));
    rac4i65_core_dff_1 settled_1 (.d(settled_1_d), .q(settled_1_q), .clock(clock));
    rac4i65_core_dff_1 settled (.d(settled_d), .q(settled_q), .clock(clock));
    rac4i65_core_dff_1 last_a (.d(last_a_d), .q(last_a_q), .clock(clock));
    rac4i65_core_dff_1 last_b (.d(last_b_d), .q(last_b_q), .clock(clock));
    rac4i65_core_dff_16 live_count (.d(live_count_d), .q(live_count_q), .clock(clock));
    rac4i65_core_dff_24_2 live_time (.d(live_time_d), .q(live_time_q), .clock(clock));
    rac4i65_core_dff_1 live_direction (.d(live_direction_d), .q(live_direction_q), .clock(clock));
    rac4i65_core_dff_16 sampled_count (.d(sampled_count_d), .q(sampled_count_q), .clock(clock));
    rac4i65_core_dff_24_2 sampled_time (.d(sampled_time_d), .q(sampled_time_q), .clock(clock));
    rac4i65_core_dff_1 sampled_direction (.d(sampled_direction_d), .q(sampled_direction_q), .clock(clock));
    rac4i65_core_dff_1 sticky_error (.d(sticky_error_d), .q(sticky_error_q), .clock(clock));

    always @(*) begin
        last_index_d = last_index_q;
        last_a_d = last_a_q;
        last_b_d = last_b_q;
        line_a_tick = 1'b1;
        line_b_tick = 1'b1;
        line_index_tick = 1'b1;
        last_a_d = line_a_value;
        last_b_d = line_b_value;
        last_index_d = line_index_value;
        if (~settled_q) begin
            last_a_d = line_a_synchronised;
            last_b_d = line_b_synchronised;
            last_index_d = line_index_synchronised;
        end
    end

    always @(*) begin
        captured_d = captured_q;
        waiting_d = waiting_q;
        seen_d = seen_q;
        fresh_d = fresh_q;
        sampled_event_d = sampled_event_q;
        sampled_capture_d = sampled_capture_q;
        if (sample) begin
            sampled_event_d = fresh_q;
            sampled_capture_d = captured_q;
            fresh_d = 1'b0;
        end
        if (arm_index) begin
            seen_d = 1'b0;
        end
        if (captures) begin
            captured_d = live_count_q;
            waiting_d = 1'b0;
            seen_d = 1'b1;
            fresh_d = 1'b1;
        end
        if (arm_index) begin
            waiting_d = 1'b1;
        end
    end

    always @(*) begin
        settled_0_d = settled_0_q;
        settled_0_d = 1'b1;
    end

    always @(*) begin
        settled_1_d = settled_1_q;
        settled_1_d = settled_0_q;
    end

    always @(*) begin
        settled_d = settled_q;
        settled_d = settled_1_q;
    end

    always @(*) begin
        live_count_d = live_count_q;
        live_time_d = live_time_q;
        live_direction_d = live_direction_q;
        if (counts) begin
            live_count_d = live_count_q + change;
            live_time_d = now;
            live_direction_d = upward;
        end
    end

    always @(*) begin
        sampled_count_d = sampled_count_q;
        sampled_time_d = sampled_time_q;
        sampled_direction_d = sampled_direction_q;
        if (sample) begin
            sampled_count_d = live_count_q;
            sampled_time_d = live_time_q;
            sampled_direction_d = live_direction_q;
        end
    end

    always @(*) begin
        sticky_error_d = sticky_error_q;
        if (clear_error) begin
            sticky_error_d = 1'b0;
        end
        if (change_a & change_b) begin
            sticky_error_d = 1'b1;
        end
    end

    always @(*) begin
        line_a_load = ~settled_q;
        line_b_load = ~settled_q;
        line_index_load = ~settled_q;
    end

    always @(*) change_a = settled_q & (line_a_value ^ last_a_q);
    always @(*) change_b = settled_q & (line_b_value ^ last_b_q);
    always @(*) upward = line_a_value ^ last_b_q;

    always @(*) begin
        change = backward;
        if (upward) begin
            change = forward;
        end
    end

    always @(*) counts = change_a ^ change_b;
    always @(*) captures = settled_q & line_index_value & ~last_index_q & waiting_q;
    always @(*) count = sampled_count_q;
    always @(*) edge_time = sampled_time_q;
    always @(*) direction = sampled_direction_q;
    always @(*) error = sticky_error_q;
    always @(*) live_a = line_a_value;
    always @(*) live_b = line_b_value;
    always @(*) step = counts;
    always @(*) up = upward;
    always @(*) live_index = line_index_value;
    always @(*) index_count = sampled_capture_q;
    always @(*) index_event = sampled_event_q;
    always @(*) index_waiting = waiting_q;
    always @(*) index_seen = seen_q;
endmodule

module rac4i65_core_stalls (
    input wire clock,
    input wire enable,
    input wire step,
    input wire up,
    input wire load,
    input wire [12:0] compare,
    input wire [12:0] threshold,
    input wire window,
    input wire clear,
    output reg stalled
);

    // Constants
    localparam zero = 3'b0;
    localparam one = 3'b1;
    localparam three = 3'b11;
    localparam minus_one = 3'b111;
    localparam minus_three = 3'b101;

    // Pins of the parts
    reg [2:0] net_d;
    wire [2:0] net_q;

    reg moved_d;
    wire moved_q;

    reg driven_d;
    wire driven_q;

    reg sticky_d;
    wire sticky_q;

    // Intermediate values
    reg [2:0] higher;
    reg [2:0] lower;
    reg highest;
    reg lowest;
    reg idles;

    // Parts
    rac4i65_core_dff_3 net (.d(net_d), .q(net_q), .clock(clock));
    rac4i65_core_dff_1 moved (.d(moved_d), .q(moved_q), .clock(clock));
    rac4i65_core_dff_1 driven (.d(driven_d), .q(driven_q), .clock(clock));
    rac4i65_core_dff_1 sticky (.d(sticky_d), .q(sticky_q), .clock(clock));

    always @(*) begin
        net_d = net_q;
        moved_d = moved_q;
        driven_d = driven_q;
        sticky_d = sticky_q;
        if (window) begin
            net_d = zero;
        end
        if (step) begin
            if (up) begin
                if (window | ~highest) begin
                    net_d = higher;
                end
                if (highest) begin
                    moved_d = 1'b1;
                end
            end
            else begin
                if (window | ~lowest) begin
                    net_d = lower;
                end
                if (lowest) begin
                    moved_d = 1'b1;
                end
            end
        end
        if (idles) begin
            driven_d = 1'b0;
        end
        if (clear) begin
            sticky_d = 1'b0;
        end
        if (window) begin
            moved_d = 1'b0;
            driven_d = ~idles;
            if (enable & driven_q & ~moved_q) begin
                sticky_d = 1'b1;
            end
        end
        if (~enable) begin
            driven_d = 1'b0;
        end
    end

    always @(*) begin
        higher = net_q + one;
        lower = net_q - one;
        if (window) begin
            higher = one;
            lower = minus_one;
        end
    end

    always @(*) begin
        highest = net_q == three;
        lowest = net_q == minus_three;
    end

    always @(*) idles = load & ~(compare > threshold);
    always @(*) stalled = sticky_q;
endmodule

module rac4i65_core_drives (
    input wire clock,
    input wire enable,
    input wire stops,
    input wire [12:0] period,
    input wire [9:0] blanking,
    input wire load,
    input wire [12:0] compare,
    input wire direction,
    input wire sync,
    input wire up_down,
    output reg pwm,
    output reg dir,
    output reg period_start,
    output reg [12:0] position
);

    // Constants
    localparam no_compare = 13'b0;
    localparam one = 13'b1;
    localparam quiet_zero = 10'b0;
    localparam quiet_one = 10'b1;

    // Pins of the parts
    reg [12:0] coming_d;
    wire [12:0] coming_q;

    reg [12:0] shadow_compare_d;
    wire [12:0] shadow_compare_q;

    reg shadow_direction_d;
    wire shadow_direction_q;

    reg [12:0] active_compare_d;
    wire [12:0] active_compare_q;

    reg active_direction_d;
    wire active_direction_q;

    reg [9:0] quiet_d;
    wire [9:0] quiet_q;

    reg rested_d;
    wire rested_q;

    reg settled_d;
    wire settled_q;

    reg pwm_pin_d;
    wire pwm_pin_q;

    reg dir_pin_d;
    wire dir_pin_q;

    reg start_d;
    wire start_q;

    // Intermediate values
    reg [12:0] after;
    reg last;
    reg running;
    reg wraps;
    reg long_quiet;
    reg aligned;
    reg turns;
    reg permitted;

    // Parts
    rac4i65_core_dff_13 coming (.d(coming_d), .q(coming_q), .clock(clock));
    rac4i65_core_dff_13 shadow_compare (.d(shadow_compare_d), .q(shadow_compare_q), .clock(clock));
    rac4i65_core_dff_1 shadow_direction (.d(shadow_direction_d), .q(shadow_direction_q), .clock(clock));
    rac4i65_core_dff_13 active_compare (.d(active_compare_d), .q(active_compare_q), .clock(clock));
    rac4i65_core_dff_1 active_direction (.d(active_direction_d), .q(active_direction_q), .clock(clock));
    rac4i65_core_dff_10 quiet (.d(quiet_d), .q(quiet_q), .clock(clock));
    rac4i65_core_dff_1 rested (.d(rested_d), .q(rested_q), .clock(clock));
    rac4i65_core_dff_1 settled (.d(settled_d), .q(settled_q), .clock(clock));
    rac4i65_core_dff_1 pwm_pin (.d(pwm_pin_d), .q(pwm_pin_q), .clock(clock));
    rac4i65_core_dff_1 dir_pin (.d(dir_pin_d), .q(dir_pin_q), .clock(clock));
    rac4i65_core_dff_1 start (.d(start_d), .q(start_q), .clock(clock));

    always @(*) begin
        coming_d = coming_q;
        coming_d = after;
        if (last) begin
            coming_d = one;
        end
    end

    always @(*) begin
        shadow_compare_d = shadow_compare_q;
        shadow_direction_d = shadow_direction_q;
        active_compare_d = active_compare_q;
        active_direction_d = active_direction_q;
        if (load) begin
            shadow_compare_d = compare;
            shadow_direction_d = direction;
        end
        if (wraps) begin
            active_compare_d = shadow_compare_q;
            active_direction_d = shadow_direction_q;
        end
        if (~enable) begin
            shadow_compare_d = no_compare;
            shadow_direction_d = 1'b0;
            active_compare_d = no_compare;
            active_direction_d = 1'b0;
        end
    end

    always @(*) begin
        quiet_d = quiet_q;
        rested_d = rested_q;
        if (~long_quiet) begin
            quiet_d = quiet_q + quiet_one;
        end
        rested_d = long_quiet;
        if (turns | pwm_pin_q | ~enable) begin
            quiet_d = quiet_zero;
            rested_d = 1'b0;
        end
    end

    always @(*) begin
        settled_d = settled_q;
        settled_d = permitted & ~turns;
    end

    always @(*) begin
        pwm_pin_d = pwm_pin_q;
        pwm_pin_d = permitted & ~stops & running & aligned & ~(coming_q > active_compare_q);
    end

    always @(*) begin
        dir_pin_d = dir_pin_q;
        if (turns) begin
            dir_pin_d = active_direction_q;
        end
    end

    always @(*) begin
        start_d = start_q;
        start_d = wraps;
    end

    always @(*) running = |period;

    always @(*) begin
        after = coming_q + one;
        position = coming_q;
    end

    always @(*) last = (coming_q >= period) | sync;
    always @(*) wraps = last & running;
    always @(*) long_quiet = quiet_q >= blanking;
    always @(*) aligned = ~(active_direction_q ^ dir_pin_q);
    always @(*) turns = enable & ~aligned & |active_compare_q & rested_q & ~pwm_pin_q;
    always @(*) permitted = enable & (settled_q | rested_q);

    always @(*) begin
        pwm = pwm_pin_q;
        dir = dir_pin_q;
        if (up_down) begin
            pwm = pwm_pin_q & ~dir_pin_q;
            dir = pwm_pin_q & dir_pin_q;
        end
    end

    always @(*) period_start = start_q;
endmodule

module rac4i65_core_dff_1 (
    input wire d,
    output reg q,
    input wire clock
);

    initial begin
        q = 1'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_1_from_1 (
    input wire d,
    output reg q,
    input wire clock
);

    initial begin
        q = 1'h1;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_2 (
    input wire [1:0] d,
    output reg [1:0] q,
    input wire clock
);

    initial begin
        q = 2'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_3 (
    input wire [2:0] d,
    output reg [2:0] q,
    input wire clock
);

    initial begin
        q = 3'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_4 (
    input wire [3:0] d,
    output reg [3:0] q,
    input wire clock
);

    initial begin
        q = 4'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_4_from_3 (
    input wire [3:0] d,
    output reg [3:0] q,
    input wire clock
);

    initial begin
        q = 4'h3;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_4_from_f (
    input wire [3:0] d,
    output reg [3:0] q,
    input wire clock
);

    initial begin
        q = 4'hf;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_5 (
    input wire [4:0] d,
    output reg [4:0] q,
    input wire clock
);

    initial begin
        q = 5'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_6 (
    input wire [5:0] d,
    output reg [5:0] q,
    input wire clock
);

    initial begin
        q = 6'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_6_from_1 (
    input wire [5:0] d,
    output reg [5:0] q,
    input wire clock
);

    initial begin
        q = 6'h1;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_6_from_21 (
    input wire [5:0] d,
    output reg [5:0] q,
    input wire clock
);

    initial begin
        q = 6'h21;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_7 (
    input wire [6:0] d,
    output reg [6:0] q,
    input wire clock
);

    initial begin
        q = 7'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_8 (
    input wire [7:0] d,
    output reg [7:0] q,
    input wire clock
);

    initial begin
        q = 8'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_8_from_ff (
    input wire [7:0] d,
    output reg [7:0] q,
    input wire clock
);

    initial begin
        q = 8'hff;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_9 (
    input wire [8:0] d,
    output reg [8:0] q,
    input wire clock
);

    initial begin
        q = 9'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_10 (
    input wire [9:0] d,
    output reg [9:0] q,
    input wire clock
);

    initial begin
        q = 10'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_10_from_21 (
    input wire [9:0] d,
    output reg [9:0] q,
    input wire clock
);

    initial begin
        q = 10'h21;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_11 (
    input wire [10:0] d,
    output reg [10:0] q,
    input wire clock
);

    initial begin
        q = 11'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_13 (
    input wire [12:0] d,
    output reg [12:0] q,
    input wire clock
);

    initial begin
        q = 13'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_14 (
    input wire [13:0] d,
    output reg [13:0] q,
    input wire clock
);

    initial begin
        q = 14'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_16 (
    input wire [15:0] d,
    output reg [15:0] q,
    input wire clock
);

    initial begin
        q = 16'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_16_from_1 (
    input wire [15:0] d,
    output reg [15:0] q,
    input wire clock
);

    initial begin
        q = 16'h1;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_16_from_1e (
    input wire [15:0] d,
    output reg [15:0] q,
    input wire clock
);

    initial begin
        q = 16'h1e;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_16_from_c8 (
    input wire [15:0] d,
    output reg [15:0] q,
    input wire clock
);

    initial begin
        q = 16'hc8;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_20 (
    input wire [19:0] d,
    output reg [19:0] q,
    input wire clock
);

    initial begin
        q = 20'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_24 (
    input wire [23:0] d,
    output reg [23:0] q,
    input wire clock
);

    initial begin
        q = 24'h196e6b;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_24_2 (
    input wire [23:0] d,
    output reg [23:0] q,
    input wire clock
);

    initial begin
        q = 24'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_24_from_1 (
    input wire [23:0] d,
    output reg [23:0] q,
    input wire clock
);

    initial begin
        q = 24'h1;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_24_from_8235 (
    input wire [23:0] d,
    output reg [23:0] q,
    input wire clock
);

    initial begin
        q = 24'h8235;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_25 (
    input wire [24:0] d,
    output reg [24:0] q,
    input wire clock
);

    initial begin
        q = 25'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_28 (
    input wire [27:0] d,
    output reg [27:0] q,
    input wire clock
);

    initial begin
        q = 28'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_29 (
    input wire [28:0] d,
    output reg [28:0] q,
    input wire clock
);

    initial begin
        q = 29'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_32 (
    input wire [31:0] d,
    output reg [31:0] q,
    input wire clock
);

    initial begin
        q = 32'h0;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

module rac4i65_core_dff_32_from_52414353 (
    input wire [31:0] d,
    output reg [31:0] q,
    input wire clock
);

    initial begin
        q = 32'h52414353;
    end

    always @(posedge clock) begin
        q <= d;
    end
endmodule

`default_nettype wire
