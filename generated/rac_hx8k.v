// rac_hx8k
// Written from the rust-hdl sources in hdl/src; register map 2.3.
// Do not edit: change the sources and run `racbot generate`.

`default_nettype none

module rac_hx8k (
    input wire clk_12,
    input wire rx,
    output wire tx,
    output wire [7:0] led,
    input wire emergency_stop,
    output wire int_n,
    input wire [3:0] encoder_a,
    input wire [3:0] encoder_b,
    input wire [3:0] encoder_index,
    output wire [3:0] pwm,
    output wire [3:0] dir,
    output wire [3:0] enable_n,
    output wire kicker_charge_n,
    output wire kicker_trigger_n,
    output wire kicker_discharge,
    input wire kicker_full,
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

    wire clock;
    wire locked;

    SB_PLL40_CORE #(.FEEDBACK_PATH("SIMPLE"), .DIVR(4'd0), .DIVF(7'd87), .DIVQ(3'd5), .FILTER_RANGE(3'd1)) pll (
        .REFERENCECLK(clk_12), .PLLOUTGLOBAL(clock), .LOCK(locked), .RESETB(1'b1), .BYPASS(1'b0)
    );

    rac_hx8k_logic board (
        .clock(clock),
        .crystal(clk_12),
        .rx(rx),
        .tx(tx),
        .led(led),
        .emergency_stop(emergency_stop | ~locked),
        .int_n(int_n),
        .encoder_a(encoder_a),
        .encoder_b(encoder_b),
        .encoder_index(encoder_index),
        .pwm(pwm),
        .dir(dir),
        .enable_n(enable_n),
        .kicker_charge_n(kicker_charge_n),
        .kicker_trigger_n(kicker_trigger_n),
        .kicker_discharge(kicker_discharge),
        .kicker_full(kicker_full),
        .ball_sensor(ball_sensor),
        .radio_rx(radio_rx),
        .host_select(host_select),
        .robot_number(robot_number),
        .imu_cs_n(imu_cs_n),
        .imu_sclk(imu_sclk),
        .imu_mosi(imu_mosi),
        .imu_miso(imu_miso),
        .imu_ready(imu_ready)
    );
endmodule

module rac_hx8k_logic (
    input wire clock,
    input wire crystal,
    input wire rx,
    output wire tx,
    output wire [7:0] led,
    input wire emergency_stop,
    output wire int_n,
    input wire [3:0] encoder_a,
    input wire [3:0] encoder_b,
    input wire [3:0] encoder_index,
    output wire [3:0] pwm,
    output wire [3:0] dir,
    output wire [3:0] enable_n,
    output wire kicker_charge_n,
    output wire kicker_trigger_n,
    output wire kicker_discharge,
    input wire kicker_full,
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

    wire ads_n;
    wire blast_n;
    wire lw_r;
    wire ready_n;
    wire lad_drive;
    wire [31:0] to_core;
    wire [31:0] from_core;
    wire [7:0] led_n;
    assign led = ~led_n;

    rac_hx8k_host host (
        .clock(clock),
        .rx(rx),
        .tx(tx),
        .ads_n(ads_n),
        .blast_n(blast_n),
        .lw_r(lw_r),
        .to_core(to_core),
        .from_core(from_core),
        .ready_n(ready_n)
    );

    rac4i65_core core (
        .lclk(clock),
        .synclk(crystal),
        .ads_n(ads_n),
        .blast_n(blast_n),
        .lw_r(lw_r),
        .lad_in(to_core),
        .lad_out(from_core),
        .lad_drive(lad_drive),
        .ready_n(ready_n),
        .led_n(led_n),
        .board(32'h4858384b),
        .clock_hz(32'd33000000),
        .emergency_stop(emergency_stop),
        .int_n(int_n),
        .encoder_a(encoder_a),
        .encoder_b(encoder_b),
        .encoder_index(encoder_index),
        .pwm(pwm),
        .dir(dir),
        .enable_n(enable_n),
        .kicker_charge_n(kicker_charge_n),
        .kicker_trigger_n(kicker_trigger_n),
        .kicker_discharge(kicker_discharge),
        .kicker_full(kicker_full),
        .ball_sensor(ball_sensor),
        .radio_rx(radio_rx),
        .host_select(host_select),
        .robot_number(robot_number),
        .imu_cs_n(imu_cs_n),
        .imu_sclk(imu_sclk),
        .imu_mosi(imu_mosi),
        .imu_miso(imu_miso),
        .imu_ready(imu_ready)
    );
endmodule

module rac_hx8k_host (
    input wire clock,
    input wire rx,
    output reg tx,
    output reg ads_n,
    output reg blast_n,
    output reg lw_r,
    output reg [31:0] to_core,
    input wire [31:0] from_core,
    input wire ready_n
);

    // Constants
    localparam whole_bit = 6'b100000;
    localparam no_clocks = 6'b0;
    localparam one_clock = 6'b1;
    localparam no_bits = 4'h0;
    localparam one_bit = 4'h1;
    localparam stop_bit = 4'h9;
    localparam no_byte = 8'h0;
    localparam silent = 14'b10000000000000;
    localparam no_silence = 14'b0;
    localparam one_silence = 14'b1;
    localparam start = 3'b0;
    localparam one_position = 3'b1;
    localparam at_crc_of_read = 3'b11;
    localparam at_crc_of_write = 3'b111;
    localparam read_letter = 8'h52;
    localparam write_letter = 8'h57;
    localparam read_reply = 8'h72;
    localparam write_reply = 8'h77;
    localparam error_reply = 8'h65;
    localparam one_byte = 3'b1;
    localparam five_bytes = 3'b101;
    localparam no_high = 2'b0;

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

    reg rx_check_clear;

    wire [7:0] rx_check_state;

    reg tx_check_shift;
    reg tx_check_line;
    wire [7:0] tx_check_state;
    reg [13:0] silence_d;
    wire [13:0] silence_q;

    reg [2:0] position_d;
    wire [2:0] position_q;

    reg is_write_d;
    wire is_write_q;

    reg [15:0] address_d;
    wire [15:0] address_q;

    reg [31:0] data_d;
    wire [31:0] data_q;

    reg calling_d;
    wire calling_q;

    reg waiting_d;
    wire waiting_q;

    reg replying_d;
    wire replying_q;

    reg failed_d;
    wire failed_q;

    reg [5:0] tx_clocks_d;
    wire [5:0] tx_clocks_q;

    reg [3:0] tx_bit_d;
    wire [3:0] tx_bit_q;

    reg [2:0] tx_position_d;
    wire [2:0] tx_position_q;

    reg [7:0] tx_byte_d;
    wire [7:0] tx_byte_q;

    reg tx_low_d;
    wire tx_low_q;

    // Intermediate values
    reg byte_done;
    reg [7:0] heard;
    reg at_start;
    reg good;
    reg reads;
    reg writes;
    reg frame_done;
    reg tx_tick;
    reg tx_last;
    reg tx_sends_crc;
    reg answers;
    reg [7:0] next_tx_byte;
    reg [2:0] tx_after;
    reg [2:0] following;

    // Parts
    rac_hx8k_host_receiver receiver(
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
    rac_hx8k_host_rx_check rx_check(
        .clock(clock),
        .clear(rx_check_clear),
        .shift(receiver_data_bit),
        .line(receiver_level),
        .state(rx_check_state)
    );
    rac_hx8k_host_rx_check tx_check(
        .clock(clock),
        .clear(answers),
        .shift(tx_check_shift),
        .line(tx_check_line),
        .state(tx_check_state)
    );
    rac_hx8k_host_dff_14 silence (.d(silence_d), .q(silence_q), .clock(clock));
    rac_hx8k_host_dff_3 position (.d(position_d), .q(position_q), .clock(clock));
    rac_hx8k_host_dff_1 is_write (.d(is_write_d), .q(is_write_q), .clock(clock));
    rac_hx8k_host_dff_16 address (.d(address_d), .q(address_q), .clock(clock));
    rac_hx8k_host_dff_32 data (.d(data_d), .q(data_q), .clock(clock));
    rac_hx8k_host_dff_1 calling (.d(calling_d), .q(calling_q), .clock(clock));
    rac_hx8k_host_dff_1 waiting (.d(waiting_d), .q(waiting_q), .clock(clock));
    rac_hx8k_host_dff_1 replying (.d(replying_d), .q(replying_q), .clock(clock));
    rac_hx8k_host_dff_1 failed (.d(failed_d), .q(failed_q), .clock(clock));
    rac_hx8k_host_dff_6 tx_clocks (.d(tx_clocks_d), .q(tx_clocks_q), .clock(clock));
    rac_hx8k_host_dff_4 tx_bit (.d(tx_bit_d), .q(tx_bit_q), .clock(clock));
    rac_hx8k_host_dff_3 tx_position (.d(tx_position_d), .q(tx_position_q), .clock(clock));
    rac_hx8k_host_dff_8 tx_byte (.d(tx_byte_d), .q(tx_byte_q), .clock(clock));
    rac_hx8k_host_dff_1 tx_low (.d(tx_low_d), .q(tx_low_q), .clock(clock));

    always @(*) begin
        silence_d = silence_q;
        silence_d = silence_q + one_silence;
        if (receiver_hearing | at_start) begin
            silence_d = no_silence;
        end
    end

    always @(*) begin
        position_d = position_q;
        is_write_d = is_write_q;
        address_d = address_q;
        data_d = data_q;
        waiting_d = waiting_q;
        replying_d = replying_q;
        failed_d = failed_q;
        tx_clocks_d = tx_clocks_q;
        tx_bit_d = tx_bit_q;
        tx_position_d = tx_position_q;
        tx_byte_d = tx_byte_q;
        tx_low_d = tx_low_q;
        if (byte_done) begin
            if (at_start) begin
                is_write_d = writes;
                if (reads | writes) begin
                    position_d = one_position;
                end
            end
            else begin
                position_d = position_q + one_position;
                if (frame_done) begin
                    position_d = start;
                end
                else if (position_q < at_crc_of_read) begin
                    address_d = (address_q >> 32'h8) | (((heard) & 16'hffff) << 32'h8);
                end
                else begin
                    data_d = (data_q >> 32'h8) | (((heard) & 32'hffffffff) << 32'h18);
                end
            end
        end
        if (silence_q == silent) begin
            position_d = start;
        end
        to_core = data_q;
        if (calling_q) begin
            to_core = ((address_q) & 32'hffffffff) << 32'h2;
            waiting_d = 1'b1;
        end
        if (waiting_q & ~ready_n) begin
            waiting_d = 1'b0;
            if (~is_write_q) begin
                data_d = from_core;
            end
        end
        tx_check_shift = 1'b0;
        if (replying_q) begin
            tx_clocks_d = tx_clocks_q - one_clock;
        end
        if (tx_tick) begin
            tx_clocks_d = whole_bit;
            tx_bit_d = tx_bit_q + one_bit;
            if (tx_bit_q == no_bits) begin
                tx_low_d = 1'b1;
            end
            else if (tx_bit_q == stop_bit) begin
                tx_low_d = 1'b0;
                tx_bit_d = no_bits;
                tx_position_d = following;
                tx_byte_d = next_tx_byte;
                data_d = data_q >> 32'h8;
                if (tx_last) begin
                    replying_d = 1'b0;
                end
            end
            else begin
                tx_low_d = ~tx_byte_q[32'h0];
                tx_byte_d = tx_byte_q >> 32'h1;
                tx_check_shift = 1'b1;
            end
        end
        if (answers) begin
            replying_d = 1'b1;
            failed_d = frame_done;
            tx_position_d = start;
            tx_bit_d = no_bits;
            tx_clocks_d = whole_bit;
            tx_byte_d = read_reply;
            if (is_write_q) begin
                tx_byte_d = write_reply;
            end
            if (frame_done) begin
                tx_byte_d = error_reply;
            end
        end
    end

    always @(*) begin
        calling_d = calling_q;
        calling_d = frame_done & good;
    end

    always @(*) at_start = position_q == start;
    always @(*) receiver_enable = ~replying_q & ~waiting_q & ~calling_q;
    always @(*) rx_check_clear = receiver_start & at_start;
    always @(*) byte_done = receiver_byte_done;
    always @(*) heard = receiver_value;

    always @(*) begin
        reads = at_start & (heard == read_letter);
        writes = at_start & (heard == write_letter);
    end

    always @(*) good = (rx_check_state == no_byte) & (address_q[(32'he)+:(2)] == no_high);
    always @(*) frame_done = byte_done & ((is_write_q & (position_q == at_crc_of_write)) | (~is_write_q & (position_q == at_crc_of_read)));
    always @(*) ads_n = ~calling_q;
    always @(*) blast_n = ~waiting_q;
    always @(*) lw_r = is_write_q;
    always @(*) tx_tick = replying_q & (tx_clocks_q == no_clocks);

    always @(*) begin
        tx_after = one_byte;
        if (~failed_q & ~is_write_q) begin
            tx_after = five_bytes;
        end
    end

    always @(*) tx_sends_crc = tx_position_q == tx_after;
    always @(*) tx_last = tx_sends_crc & (tx_bit_q == stop_bit);

    always @(*) begin
        next_tx_byte = data_q[(32'h0)+:(8)];
        if (following == tx_after) begin
            next_tx_byte = tx_check_state;
        end
    end

    always @(*) following = tx_position_q + one_position;
    always @(*) tx_check_line = tx_byte_q[32'h0];
    always @(*) answers = (waiting_q & ~ready_n) | (frame_done & ~good);
    always @(*) tx = ~tx_low_q;
endmodule

module rac_hx8k_host_receiver (
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
    localparam half_bit = 9'b1111;
    localparam whole_bit = 9'b100000;
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
    rac_hx8k_host_dff_1 low_1 (.d(low_1_d), .q(low_1_q), .clock(clock));
    rac_hx8k_host_dff_1 low_2 (.d(low_2_d), .q(low_2_q), .clock(clock));
    rac_hx8k_host_dff_1 hears (.d(hears_d), .q(hears_q), .clock(clock));
    rac_hx8k_host_dff_9 clocks (.d(clocks_d), .q(clocks_q), .clock(clock));
    rac_hx8k_host_dff_4 bits (.d(bits_d), .q(bits_q), .clock(clock));
    rac_hx8k_host_dff_8 shift (.d(shift_d), .q(shift_q), .clock(clock));

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

module rac_hx8k_host_rx_check (
    input wire clock,
    input wire clear,
    input wire shift,
    input wire line,
    output reg [7:0] state
);

    // Constants
    localparam taps = 8'he0;
    localparam zero = 8'h0;

    // Pins of the parts
    reg [7:0] register_d;
    wire [7:0] register_q;

    // Intermediate values
    reg feedback;

    // Parts
    rac_hx8k_host_dff_8 register (.d(register_d), .q(register_q), .clock(clock));

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

module rac_hx8k_host_dff_1 (
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

module rac_hx8k_host_dff_3 (
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

module rac_hx8k_host_dff_4 (
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

module rac_hx8k_host_dff_6 (
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

module rac_hx8k_host_dff_8 (
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

module rac_hx8k_host_dff_9 (
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

module rac_hx8k_host_dff_14 (
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

module rac_hx8k_host_dff_16 (
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

module rac_hx8k_host_dff_32 (
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

`default_nettype wire
