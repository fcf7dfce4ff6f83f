// Every access is answered: READY# comes at most 66 clocks after ADS# or after the word before it,
// whatever the host and the core do, and never without an access. The card drives the bus only
// while it owes words of a read. Writes come at least two clocks apart.
localparam FORMAL_LONGEST = 65;
reg formal_open = 0;         // the host waits for a word
reg formal_reads = 0;
reg [6:0] formal_wait = 0;   // clocks it has waited, this one not counted
reg [1:0] formal_written = 3;  // clocks since the last write strobe, saturated
reg formal_strobe = 0;       // ADS# was low at the last edge
wire formal_last = answer_q && ends;

always @(posedge clock) begin
    formal_strobe <= !ads_n;
    if (!ads_n) begin
        formal_open <= 1;
        formal_wait <= 0;
        formal_reads <= !lw_r;
    end else if (formal_open) begin
        formal_open <= !formal_last;
        formal_wait <= answer_q ? 7'd0 : formal_wait + 7'd1;
    end
    formal_written <= write ? 2'd0 : formal_written + !(&formal_written);
end

always @(*) begin
    if (formal_open) assert (formal_wait <= FORMAL_LONGEST);
    if (!ready_n) assert (formal_open);
    if (lad_drive) assert (formal_open && formal_reads && !formal_strobe);
    if (read) assert (formal_open && formal_reads);
    assert (claims == (fetch_q || offer_q));
    assert (!(read && write));
    assert (!(write && write_busy));
    if (write) assert (formal_open && !formal_reads && formal_written >= 1);
    // Invariants that carry the induction.
    assert (formal_open == (fetch_q || pending_q || take_q || collect_q || offer_q || answer_q));
    assert ({2'd0, fetch_q} + pending_q + take_q + collect_q + offer_q + answer_q <= 1);
    if (formal_open) assert (writing_q == !formal_reads);
    if (fetch_q || pending_q || take_q) assert (formal_reads);
    if (collect_q || offer_q) assert (!formal_reads);
    if (fetch_q || collect_q) assert (formal_wait == 0);
    if (pending_q) assert (formal_wait == 1);
    if (take_q) assert (formal_wait == 2);
    if (offer_q) assert (formal_wait == held_q + 7'd1); else assert (held_q == 0);
    if (formal_open && answer_q) assert (formal_wait >= (formal_reads ? 3 : 2) && formal_wait <= FORMAL_LONGEST);
    if (formal_strobe) assert (fetch_q || collect_q);
end
