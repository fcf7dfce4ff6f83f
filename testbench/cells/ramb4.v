// Block memory of the Spartan-II with 256 words of 16 bits, as Xilinx describes it: a write shows the
// new word at its own port, a reset clears the output. A port that reads the word which the other
// port writes in the same clock gets garbage here, on purpose: on the device it is not defined.
module RAMB4_S16_S16 #(
    parameter [255:0]
    INIT_00 = 256'd0, INIT_01 = 256'd0, INIT_02 = 256'd0, INIT_03 = 256'd0,
    INIT_04 = 256'd0, INIT_05 = 256'd0, INIT_06 = 256'd0, INIT_07 = 256'd0,
    INIT_08 = 256'd0, INIT_09 = 256'd0, INIT_0A = 256'd0, INIT_0B = 256'd0,
    INIT_0C = 256'd0, INIT_0D = 256'd0, INIT_0E = 256'd0, INIT_0F = 256'd0
) (
    output reg [15:0] DOA,
    output reg [15:0] DOB,
    input wire [7:0] ADDRA,
    input wire [7:0] ADDRB,
    input wire [15:0] DIA,
    input wire [15:0] DIB,
    input wire ENA,
    input wire ENB,
    input wire CLKA,
    input wire CLKB,
    input wire RSTA,
    input wire RSTB,
    input wire WEA,
    input wire WEB
);
    reg [15:0] mem [0:255];
    wire same = ENA && ENB && ADDRA == ADDRB;
    integer word;
    initial begin
        DOA = 0;
        DOB = 0;
        for (word = 0; word < 16; word = word + 1) begin
            mem[0 + word] = INIT_00[16 * word +: 16];
            mem[16 + word] = INIT_01[16 * word +: 16];
            mem[32 + word] = INIT_02[16 * word +: 16];
            mem[48 + word] = INIT_03[16 * word +: 16];
            mem[64 + word] = INIT_04[16 * word +: 16];
            mem[80 + word] = INIT_05[16 * word +: 16];
            mem[96 + word] = INIT_06[16 * word +: 16];
            mem[112 + word] = INIT_07[16 * word +: 16];
            mem[128 + word] = INIT_08[16 * word +: 16];
            mem[144 + word] = INIT_09[16 * word +: 16];
            mem[160 + word] = INIT_0A[16 * word +: 16];
            mem[176 + word] = INIT_0B[16 * word +: 16];
            mem[192 + word] = INIT_0C[16 * word +: 16];
            mem[208 + word] = INIT_0D[16 * word +: 16];
            mem[224 + word] = INIT_0E[16 * word +: 16];
            mem[240 + word] = INIT_0F[16 * word +: 16];
        end
    end
    always @(posedge CLKA) if (ENA) begin
        if (WEA) mem[ADDRA] <= DIA;
        DOA <= RSTA ? 16'd0 : WEA ? DIA : same && WEB ? ~mem[ADDRA] : mem[ADDRA];
    end
    always @(posedge CLKB) if (ENB) begin
        if (WEB) mem[ADDRB] <= DIB;
        DOB <= RSTB ? 16'd0 : WEB ? DIB : same && WEA ? ~mem[ADDRB] : mem[ADDRB];
    end
endmodule

module RAMB4_S16 #(
    parameter [255:0]
    INIT_00 = 256'd0, INIT_01 = 256'd0, INIT_02 = 256'd0, INIT_03 = 256'd0,
    INIT_04 = 256'd0, INIT_05 = 256'd0, INIT_06 = 256'd0, INIT_07 = 256'd0,
    INIT_08 = 256'd0, INIT_09 = 256'd0, INIT_0A = 256'd0, INIT_0B = 256'd0,
    INIT_0C = 256'd0, INIT_0D = 256'd0, INIT_0E = 256'd0, INIT_0F = 256'd0
) (
    output wire [15:0] DO,
    input wire [7:0] ADDR,
    input wire [15:0] DI,
    input wire EN,
    input wire CLK,
    input wire RST,
    input wire WE
);
    wire [15:0] unused;
    RAMB4_S16_S16 #(
        .INIT_00(INIT_00), .INIT_01(INIT_01), .INIT_02(INIT_02), .INIT_03(INIT_03),
        .INIT_04(INIT_04), .INIT_05(INIT_05), .INIT_06(INIT_06), .INIT_07(INIT_07),
        .INIT_08(INIT_08), .INIT_09(INIT_09), .INIT_0A(INIT_0A), .INIT_0B(INIT_0B),
        .INIT_0C(INIT_0C), .INIT_0D(INIT_0D), .INIT_0E(INIT_0E), .INIT_0F(INIT_0F)
    ) both (
        .DOA(DO), .DOB(unused), .ADDRA(ADDR), .ADDRB(8'd0), .DIA(DI), .DIB(16'd0), .ENA(EN), .ENB(1'b0),
        .CLKA(CLK), .CLKB(CLK), .RSTA(RST), .RSTB(1'b0), .WEA(WE), .WEB(1'b0)
    );
endmodule
