// Block memory of the Spartan-II, 4096 bits behind two ports of 1 to 16 bits, as Xilinx describes it: a
// write shows the new word at its own port, a reset clears the output. A port that reads bits which the
// other port writes in the same clock gets garbage here, on purpose: on the device it is not defined.
module ramb4 #(
    parameter WA = 16,
    parameter WB = 16,
    parameter AA = 8,
    parameter AB = 8,
    parameter [4095:0] INIT = 0
) (
    output reg [WA-1:0] doa,
    output reg [WB-1:0] dob,
    input wire [AA-1:0] addra,
    input wire [AB-1:0] addrb,
    input wire [WA-1:0] dia,
    input wire [WB-1:0] dib,
    input wire ena,
    input wire enb,
    input wire clka,
    input wire clkb,
    input wire rsta,
    input wire rstb,
    input wire wea,
    input wire web
);
    // Words of the wider port: both ports then address whole words or parts of one.
    localparam W = WA > WB ? WA : WB;
    localparam A = AA < AB ? AA : AB;
    reg [W-1:0] mem [0:(1 << A) - 1];
    wire [A-1:0] worda = addra >> (AA - A);
    wire [A-1:0] wordb = addrb >> (AB - A);
    wire [11:0] bita = (addra * WA) % W;
    wire [11:0] bitb = (addrb * WB) % W;
    wire meets = ena && enb && worda == wordb && bita < bitb + WB && bitb < bita + WA;
    integer word;
    initial begin
        doa = 0;
        dob = 0;
        for (word = 0; word < 1 << A; word = word + 1) mem[word] = INIT[word * W +: W];
    end
    always @(posedge clka) if (ena) begin
        if (wea) mem[worda][bita +: WA] <= dia;
        doa <= rsta ? {WA{1'b0}} : wea ? dia : meets && web ? ~mem[worda][bita +: WA] : mem[worda][bita +: WA];
    end
    always @(posedge clkb) if (enb) begin
        if (web) mem[wordb][bitb +: WB] <= dib;
        dob <= rstb ? {WB{1'b0}} : web ? dib : meets && wea ? ~mem[wordb][bitb +: WB] : mem[wordb][bitb +: WB];
    end
endmodule
