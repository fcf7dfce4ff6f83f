// Drives one Verilated module as a child process: words (32 bit, little endian) in on stdin,
// words out on stdout. `ports.h` is generated and knows the module's ports.
//
//   one step      inputs applied, clocks at their first level, settle;
//                 clocks at their second level, settle; outputs read
//   main clock    bit 0 of the levels; its rising edges are what `clock` counts
#include "ports.h"
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <vector>

using Word = uint32_t;
using Words = std::vector<Word>;

double sc_time_stamp() { return 0; }

namespace {

enum Command : Word {
    BATCH = 1, SET, GET, RUN, STEPS, SCHEDULE, RECORD, TAKE, PATTERN, BUS_PORTS, BUS
};
enum BusStatus : Word { OK = 0, NO_READY = 1, NOT_DRIVEN = 2, CONTENTION = 3 };
enum BusOperation : Word { WRITE = 0, READ = 1, WAIT = 2 };

struct Change { uint64_t clock; Word port, value; };

Model model;
Word in[IN_COUNT + 1];
Word out[OUT_COUNT + 1];
bool dirty = true;
uint64_t clocks = 0;
Words pattern{ALL_CLOCKS};
size_t phase = 0;
std::deque<Change> scheduled;
Words recorded, last;
std::vector<Change> events;

Word get() {
    Word word;
    if (fread(&word, sizeof word, 1, stdin) != 1) exit(0);
    return word;
}
uint64_t get64() { uint64_t low = get(); return low | uint64_t(get()) << 32; }
void get(Word* into, size_t n) { if (n && fread(into, sizeof(Word), n, stdin) != n) exit(0); }
Words get_list() { Words list(get()); get(list.data(), list.size()); return list; }
void put(const Word* from, size_t n) { if (n && fwrite(from, sizeof(Word), n, stdout) != n) exit(1); }
void put(Word word) { put(&word, 1); }
void put64(uint64_t word) { put(Word(word)); put(Word(word >> 32)); }

// The first half of a step; true if the main clock is about to rise.
inline bool first_half(Word levels) {
    while (!scheduled.empty() && scheduled.front().clock <= clocks) {
        in[scheduled.front().port] = scheduled.front().value;
        scheduled.pop_front();
        dirty = true;
    }
    if (dirty) { apply(model, in); dirty = false; }
    set_clocks(model, levels >> 16);
    model.eval();
    return (levels & 1) && !(levels >> 16 & 1);
}

inline void second_half(Word levels, bool rises) {
    set_clocks(model, levels & 0xffff);
    model.eval();
    if (!recorded.empty()) {
        sample(model, out);
        for (size_t i = 0; i < recorded.size(); ++i) {
            if (out[recorded[i]] == last[i]) continue;
            last[i] = out[recorded[i]];
            events.push_back({clocks, recorded[i], last[i]});
        }
    }
    clocks += rises;
}

inline Word next_levels() {
    Word levels = pattern[phase];
    if (++phase == pattern.size()) phase = 0;
    return levels;
}

inline bool step() {
    Word levels = next_levels();
    bool rises = first_half(levels);
    second_half(levels, rises);
    return rises;
}

// Steps up to and over the next rising edge of the main clock. `out` holds what another device
// samples on that very edge.
void bus_step() {
    for (size_t guard = 0; guard <= pattern.size(); ++guard) {
        Word levels = next_levels();
        bool rises = first_half(levels);
        if (rises) sample(model, out);
        if (!rises) { second_half(levels, rises); continue; }
        if (recorded.empty()) { second_half(levels, rises); return; }
        Words seen(out, out + OUT_COUNT);
        second_half(levels, rises);
        for (size_t i = 0; i < seen.size(); ++i) out[i] = seen[i];
        return;
    }
}

void run_clocks(uint64_t n) {
    uint64_t target = clocks + n;
    if (pattern.size() == 1 && pattern[0] == ALL_CLOCKS) {
        while (clocks < target) {
            uint64_t until = target;
            if (!recorded.empty()) { step(); continue; }
            if (!scheduled.empty()) {
                if (scheduled.front().clock <= clocks) { step(); continue; }
                if (scheduled.front().clock < until) until = scheduled.front().clock;
            }
            if (dirty) { apply(model, in); dirty = false; }
            for (; clocks < until; ++clocks) {
                set_clocks(model, 0);
                model.eval();
                set_clocks(model, ALL_CLOCKS);
                model.eval();
            }
        }
        return;
    }
    bool possible = false;
    for (Word levels : pattern) possible |= (levels & 1) && !(levels >> 16 & 1);
    while (possible && clocks < target) step();
}

void batch() {
    Word n = get(), per_step = get();
    Words stimulus(size_t(n) * (IN_COUNT + per_step)), response(size_t(n) * OUT_COUNT);
    get(stimulus.data(), stimulus.size());
    const Word* row = stimulus.data();
    Word* answer = response.data();
    for (Word k = 0; k < n; ++k, row += IN_COUNT, answer += OUT_COUNT) {
        Word levels = per_step ? *row++ : next_levels();
        for (Word i = 0; i < IN_COUNT; ++i) in[i] = row[i];
        dirty = true;
        bool rises = first_half(levels);
        second_half(levels, rises);
        sample(model, answer);
    }
    put(response.data(), response.size());
}

// The PLX PCI 9030 as master of the multiplexed local bus, 32 bit, READY# input enabled.
const Word NONE = 0xffffffff;
struct Bus {
    Word ads, blast, lw_r, lad, drive, ready, lad_out, lad_drive, max_wait, gap;

    void idle() {
        in[ads] = 1; in[blast] = 1; in[lw_r] = 0;
        if (drive != NONE) in[drive] = 0;
        dirty = true;
    }
    bool fpga_drives() const { return lad_drive != NONE && out[lad_drive]; }

    BusStatus cycle(bool write, Word address, Word* data, Word n) {
        in[ads] = 0; in[blast] = 1; in[lw_r] = write; in[lad] = address;
        if (drive != NONE) in[drive] = 1;
        dirty = true;
        bus_step();
        if (fpga_drives()) { idle(); return CONTENTION; }
        in[ads] = 1;
        for (Word word = 0; word < n; ++word) {
            in[blast] = word + 1 < n;
            // Nobody drives the bus in the turn-around of a read; the value must not matter.
            in[lad] = write ? data[word] : 0xa5a5a5a5;
            if (drive != NONE) in[drive] = write;
            dirty = true;
            for (Word waited = 0;; ++waited) {
                if (waited > max_wait) { idle(); return NO_READY; }
                bus_step();
                if (write && fpga_drives()) { idle(); return CONTENTION; }
                if (!out[ready]) break;
            }
            if (!write) {
                if (lad_drive != NONE && !out[lad_drive]) { idle(); return NOT_DRIVEN; }
                data[word] = out[lad_out];
            }
        }
        idle();
        for (Word k = 0; k < gap; ++k) bus_step();
        return OK;
    }
} bus;

void bus_operations() {
    Word n = get();
    struct Operation { Word kind, address; Words data; };
    std::vector<Operation> list(n);
    for (auto& op : list) {
        op.kind = get();
        op.address = get();
        Word count = get();
        op.data.resize(op.kind == WAIT ? 0 : count);
        if (op.kind == WRITE) get(op.data.data(), count);
        if (op.kind == WAIT) op.address = count;
    }
    BusStatus status = OK;
    Word done = 0;
    Words read;
    for (; done < n && status == OK; ++done) {
        auto& op = list[done];
        if (op.kind == WAIT) { run_clocks(op.address); continue; }
        status = bus.cycle(op.kind == WRITE, op.address, op.data.data(), Word(op.data.size()));
        if (status == OK && op.kind == READ) read.insert(read.end(), op.data.begin(), op.data.end());
    }
    put(status);
    put(done);
    put64(clocks);
    put(Word(read.size()));
    put(read.data(), read.size());
}

void serve(Word command) {
    switch (command) {
    case BATCH: batch(); break;
    case SET:
        for (Word n = get(); n; --n) { Word port = get(); in[port] = get(); }
        dirty = true;
        break;
    case GET: {
        Words ports = get_list();
        if (dirty) { apply(model, in); dirty = false; }
        model.eval();
        sample(model, out);
        for (Word port : ports) put(out[port]);
        break;
    }
    case RUN: run_clocks(get64()); put64(clocks); break;
    case STEPS: for (uint64_t n = get64(); n; --n) step(); put64(clocks); break;
    case SCHEDULE:
        for (Word n = get(); n; --n) {
            Change change;
            change.clock = get64();
            change.port = get();
            change.value = get();
            auto at = scheduled.end();
            while (at != scheduled.begin() && (at - 1)->clock > change.clock) --at;
            scheduled.insert(at, change);
        }
        break;
    case RECORD:
        recorded = get_list();
        last.clear();
        model.eval();
        sample(model, out);
        for (Word port : recorded) last.push_back(out[port]);
        break;
    case TAKE:
        put(Word(events.size()));
        for (auto& event : events) { put64(event.clock); put(event.port); put(event.value); }
        events.clear();
        break;
    case PATTERN: pattern = get_list(); phase = 0; break;
    case BUS_PORTS:
        get(&bus.ads, sizeof bus / sizeof(Word));
        bus.idle();
        break;
    case BUS: bus_operations(); break;
    default: fprintf(stderr, "unknown command %u\n", command); exit(2);
    }
}

}  // namespace

int main(int argc, char** argv) {
    Verilated::commandArgs(argc, argv);
    static char input[1 << 20], output[1 << 20];
    setvbuf(stdin, input, _IOFBF, sizeof input);
    setvbuf(stdout, output, _IOFBF, sizeof output);
    for (;;) {
        serve(get());
        fflush(stdout);
    }
}
