
// A delay-locked loop, ideal: its outputs follow the measured period of its input, and it locks after four periods.
// Needs a simulator with delays.
module xc2s200_dll #(parameter DIVIDE = 2) (
    input clkin, input clkfb, input rst,
    output reg clk0, output reg clk90, output reg clk180, output reg clk270,
    output reg clk2x, output reg clk2x90, output reg clkdv, output locked
);
    realtime last, period;
    reg [2:0] periods;
    integer count;
    assign locked = periods[2];
    initial begin
        {clk0, clk90, clk180, clk270, clk2x, clk2x90, clkdv} = 7'b0;
        last = 0;
        period = 0;
        periods = 3'd0;
        count = 0;
    end
    always @(posedge clkin) begin
        if (last > 0) period = $realtime - last;
        last = $realtime;
        if (rst) periods <= 3'd0;
        else if (!periods[2]) periods <= periods + 3'd1;
    end
    always @(posedge clkin) if (period > 0 && !rst) begin
        clk0 = 1; clk180 = 0; clk2x = 1; clk2x90 = 0;
        if (count == 0) clkdv = 1; else if (count == (DIVIDE + 1) / 2) clkdv = 0;
        count = count + 1 == DIVIDE ? 0 : count + 1;
        #(period / 8) clk2x90 = 1;
        #(period / 8) clk90 = 1; clk270 = 0; clk2x = 0;
        #(period / 8) clk2x90 = 0;
        #(period / 8) clk0 = 0; clk180 = 1; clk2x = 1;
        #(period / 8) clk2x90 = 1;
        #(period / 8) clk90 = 0; clk270 = 1; clk2x = 0;
        #(period / 16) clk2x90 = clk2x90;
    end
endmodule
