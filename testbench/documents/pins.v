// The chip behind its pins, for a driver on the other side of a pipe. A line of standard input is a command and
// two hexadecimal numbers; what answers, answers with one line.
//
//   r offset 0      one word by the local bus            -> the word
//   w offset word   one word                             -> ok
//   c clocks 0      lets clocks pass                     -> ok
//   p pin level     drives a pin, or a group of four     -> ok
//   o 0 0           levels of the outputs, and for each PWM pin and the trigger the clocks it was on since the
//                   last such command -> dir enable_n charge_n trigger_n discharge pwm0 pwm1 pwm2 pwm3 trigger
//
// Until it is driven a pin hangs in the air. Pins: 0 emergency_stop, 1 ball_sensor, 2 kicker_full, 3 radio_rx,
// 4 host_select, 5 encoder_a, 6 encoder_b, 7 encoder_index, 8 robot_number.
`timescale 1ns/1ns
module pins;
    reg lclk = 0, synclk = 0, ads_n = 1, blast_n = 1, lw_r = 0, drive = 0;
    reg [31:0] out = 0;
    wire [31:0] lad = drive ? out : 32'bz;
    reg emergency_stop = 1'bz, ball_sensor = 1'bz, kicker_full = 1'bz, radio_rx = 1'bz, host_select = 1'bz;
    reg [3:0] encoder_a = 4'bz, encoder_b = 4'bz, encoder_index = 4'bz, robot_number = 4'bz;
    wire ready_n, int_n, kicker_charge_n, kicker_trigger_n, kicker_discharge;
    wire [7:0] led_n;
    wire [3:0] dir, enable_n, pwm;
    wire stop_pin = emergency_stop, ball_pin = ball_sensor, full_pin = kicker_full, rx_pin = radio_rx, select_pin = host_select;
    wire [3:0] a_pins = encoder_a, b_pins = encoder_b, index_pins = encoder_index, robot_pins = robot_number;

    rac4i65 chip (
        .lclk(lclk), .synclk(synclk), .ads_n(ads_n), .blast_n(blast_n), .lw_r(lw_r), .ready_n(ready_n), .int_n(int_n),
        .lad(lad), .led_n(led_n), .dir(dir), .enable_n(enable_n), .encoder_a(a_pins), .encoder_b(b_pins),
        .encoder_index(index_pins), .pwm(pwm), .kicker_charge_n(kicker_charge_n), .kicker_trigger_n(kicker_trigger_n),
        .kicker_discharge(kicker_discharge), .kicker_full(full_pin), .emergency_stop(stop_pin),
        .ball_sensor(ball_pin), .radio_rx(rx_pin), .host_select(select_pin), .robot_number(robot_pins)
    );
    always #15 lclk = ~lclk;
    always #10 synclk = ~synclk;

    integer on [0:4];
    integer n, got, waited;
    reg [7:0] command;
    reg [31:0] first, second;
    always @(negedge lclk) begin
        for (n = 0; n < 4; n = n + 1) if (pwm[n]) on[n] = on[n] + 1;
        if (!kicker_trigger_n) on[4] = on[4] + 1;
    end

    // Pins change at falling edges and are sampled at rising ones.
    task access(input write);
        begin
            @(negedge lclk);
            ads_n = 0; lw_r = write; drive = 1; out = first;
            @(negedge lclk);
            ads_n = 1; blast_n = 0; drive = write; out = second;
            waited = 0;
            while (ready_n !== 0 && waited < 70) begin
                @(negedge lclk);
                waited = waited + 1;
            end
            if (ready_n !== 0) $display("silent");
            else if (write) $display("ok");
            else $display("%h", lad);
            @(negedge lclk);
            blast_n = 1; drive = 0; lw_r = 0;
        end
    endtask

    initial begin
        for (n = 0; n < 5; n = n + 1) on[n] = 0;
        got = 3;
        while (got == 3) begin
            got = $fscanf(32'h8000_0000, "%s %h %h", command, first, second);
            if (got == 3) case (command)
                "r": access(0);
                "w": access(1);
                "c": begin
                    repeat (first) @(negedge lclk);
                    $display("ok");
                end
                "p": begin
                    case (first)
                        0: emergency_stop = second;
                        1: ball_sensor = second;
                        2: kicker_full = second;
                        3: radio_rx = second;
                        4: host_select = second;
                        5: encoder_a = second;
                        6: encoder_b = second;
                        7: encoder_index = second;
                        8: robot_number = second;
                    endcase
                    $display("ok");
                end
                "o": begin
                    $display("%b %b %b %b %b %0d %0d %0d %0d %0d", dir, enable_n, kicker_charge_n, kicker_trigger_n,
                        kicker_discharge, on[0], on[1], on[2], on[3], on[4]);
                    for (n = 0; n < 5; n = n + 1) on[n] = 0;
                end
                default: $display("unknown");
            endcase
            $fflush;
        end
        $finish;
    end
endmodule
