// Another design for the card: a counter on its LEDs, and a bus that answers every read with one word.
module blinker (
    input wire lclk,
    input wire ads_n,
    input wire blast_n,
    input wire lw_r,
    output wire ready_n,
    inout wire [31:0] lad,
    output wire [7:0] led_n
);
    reg [15:0] count = 16'd0;
    reg busy = 1'b0;
    reg reading = 1'b0;
    assign ready_n = !busy;
    assign lad = busy && reading ? 32'h424c4e4b : 32'bz;
    assign led_n = ~count[15:8];
    always @(posedge lclk) begin
        count <= count + 16'd1;
        if (!ads_n) begin
            busy <= 1'b1;
            reading <= !lw_r;
        end else if (!blast_n) begin
            busy <= 1'b0;
        end
    end
endmodule
