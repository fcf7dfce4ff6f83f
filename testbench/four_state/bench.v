// Random bus traffic from the first clock after power-up, in four states: no output is ever unknown, nor LAD
// while the chip drives it. For the first clocks nobody drives the other pins, then all of them at random.
// Prints what it did, or the first unknown value; +clocks=N and +seed=N.
`timescale 1ns/1ns
module bench;
    reg lclk = 0, synclk = 0, ads_n = 1, blast_n = 1, lw_r = 0, drive = 0;
    reg [31:0] out = 0;
    wire [31:0] lad = drive ? out : 32'bz;
    reg [21:0] levels = 22'bz;
    wire [21:0] open = levels;
    wire ready_n, int_n, kicker_charge_n, kicker_trigger_n, kicker_discharge;
    wire [7:0] led_n;
    wire [3:0] dir, enable_n, pwm;
    wire imu_cs_n, imu_sclk, imu_mosi;
    wire [27:0] outputs = {imu_cs_n, imu_sclk, imu_mosi, ready_n, int_n, kicker_charge_n, kicker_trigger_n, kicker_discharge, led_n, dir, enable_n, pwm};

    rac4i65 chip (
        .lclk(lclk), .synclk(synclk), .ads_n(ads_n), .blast_n(blast_n), .lw_r(lw_r), .ready_n(ready_n), .int_n(int_n),
        .lad(lad), .led_n(led_n), .dir(dir), .enable_n(enable_n), .encoder_a(open[3:0]), .encoder_b(open[7:4]),
        .encoder_index(open[11:8]), .pwm(pwm), .kicker_charge_n(kicker_charge_n), .kicker_trigger_n(kicker_trigger_n),
        .kicker_discharge(kicker_discharge), .kicker_full(open[12]), .emergency_stop(open[13]),
        .ball_sensor(open[14]), .radio_rx(open[15]), .host_select(open[16]), .robot_number(open[20:17]),
        .imu_cs_n(imu_cs_n), .imu_sclk(imu_sclk), .imu_mosi(imu_mosi), .imu_miso(open[21]), .imu_ready(open[12])
    );
    always #15 lclk = ~lclk;
    always #10 synclk = ~synclk;

    integer clocks, limit, seed, reads, writes, waited;
    reg [31:0] offset, choice;

    always @(negedge lclk) begin
        clocks = clocks + 1;
        if (clocks > 400) begin
            // Encoders and the rest seldom, so that filters pass them; the stop mostly released.
            if ($random(seed) % 8 == 0) levels = {$random(seed)} % (1 << 22);
            if ($random(seed) % 4 != 0) levels[13] = 0;
        end
        #1 if ((^outputs) === 1'bx) begin
            $display("clock %0d: outputs %b", clocks, outputs);
            $finish;
        end
        if (chip.lad_drive === 1'bx || (chip.lad_drive === 1'b1 && !drive && (^lad) === 1'bx)) begin
            $display("clock %0d: offset %h reads %h", clocks, offset, lad);
            $finish;
        end
        if (clocks >= limit) begin
            $display("%0d clocks, %0d reads, %0d writes: nothing unknown", clocks, reads, writes);
            $finish;
        end
    end

    task access;
        begin
            @(negedge lclk);
            ads_n = 0; drive = 1; out = offset;
            @(negedge lclk);
            ads_n = 1; blast_n = 0; drive = lw_r;
            out = offset == 32'h20 ? 0 : $random(seed) % 3 == 0 ? 32'h4152_4d31 : $random(seed);
            waited = 0;
            while (ready_n !== 0 && waited < 70) begin
                @(negedge lclk);
                waited = waited + 1;
            end
            @(negedge lclk);
            blast_n = 1; drive = 0;
        end
    endtask

    initial begin
        if (!$value$plusargs("clocks=%d", limit)) limit = 20000;
        if (!$value$plusargs("seed=%d", seed)) seed = 1;
        clocks = 0; reads = 0; writes = 0; lw_r = 0;
        // Every word of every page once, while nobody drives a pin; then at random.
        for (offset = 0; offset < 32'h0b0; offset = offset + 4) begin
            access;
            reads = reads + 1;
        end
        forever begin
            choice = {$random(seed)};
            case (choice % 8)
                0, 1, 2: offset = {$random(seed)} % 48 * 4;
                3: offset = 32'h400 + {$random(seed)} % 128 * 4;
                4: offset = 32'h600 + {$random(seed)} % 32 * 4;
                5: offset = 32'h770 + {$random(seed)} % 12 * 4;
                6: offset = 32'h800 + {$random(seed)} % 24 * 4;
                default: offset = {$random(seed)} % 16384 * 4;
            endcase
            lw_r = choice[8] && offset != 32'h20;
            if (clocks == 0 || choice[16:12] == 0) begin
                // The shortest period, so that the program runs all the time.
                lw_r = 1;
                offset = 32'h20;
            end
            access;
            if (lw_r) writes = writes + 1;
            else reads = reads + 1;
        end
    end
endmodule
