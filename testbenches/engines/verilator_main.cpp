// Host and screen of a Cardcage machine, compiled with its Verilated model.
//
// usage: machine RESULTS expected-responses memory-seed stall-seed maximum-cycles
//                [cycle command]...
//
// The standard input has the commands as little-endian 32-bit words, up to its end; where the next
// one is late the machine's time stands still.  A negative seed is none.  In each cycle that is given
// the machine is reset, and the host goes on with the command beside it.
// RESULTS gets records, each of which begins with its code: RESPONSE kind value cycle, SCAN cycle
// and a picture, COMMANDS the number of commands taken and the cycle of each, END why, cycles and a
// reason; of a machine that is observed also ACTIVITY first cycle, clocks, clocks a bucket, buckets,
// and for each bucket, element and kind its clocks.
// Progress goes to the standard output: cycles and responses, now and then.
//
// With the single argument "bare" and a number of cycles it only toggles the clock.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "Vmachine.h"
#include "verilated.h"

// What Python knows of the machine, its words and the results; model_constants.py writes it.
#include "machine_constants.h"

// Verilator writes the second underscore of a port's name as its code.
#define PORT(interface, member) interface##___05F##member

namespace {

constexpr uint32_t OPCODE_MASK = (1u << OPCODE_BITS) - 1;
constexpr uint64_t KIND_MASK = (1u << RESPONSE_KIND_BITS) - 1;
constexpr uint64_t PROGRESS_CYCLES = 1 << 16;

// One handshake signal of the host: high, or low for a random while before.
class Pace {
  public:
    Pace(int64_t seed, uint64_t salt) : random_(seed >= 0), state_(seed * 2 + salt + 1) {}
    bool high() const { return on_ && pause_ == 0; }
    void go() {
        on_ = true;
        if (!random_) return;
        const uint64_t pick = next() % 6;
        pause_ = pick < 3 ? 0 : pick < 5 ? pick - 2 : next() % 20;
    }
    void wait() { if (pause_) --pause_; }
    void stop() { on_ = false; }

  private:
    uint64_t next() {  // splitmix64
        uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    bool random_;
    bool on_ = false;
    uint64_t state_;
    uint64_t pause_ = 0;
};

// Puts pictures together from the video pins, as a screen would.
class Monitor {
  public:
    explicit Monitor(FILE* results) : results_(results) { pixels_.reserve(3 * WIDTH * HEIGHT); }

    // False, with a reason, when the video is malformed.
    bool sample(uint64_t cycle, bool active, bool vertical_sync, uint8_t red, uint8_t green,
                uint8_t blue) {
        const bool in_sync = vertical_sync == VERTICAL_SYNC_POSITIVE;
        if (in_sync && !in_sync_ && !finish()) return false;
        in_sync_ = in_sync;
        if (active) {
            if (pixels_.empty()) first_cycle_ = cycle;
            pixels_.push_back(red);
            pixels_.push_back(green);
            pixels_.push_back(blue);
            ++line_pixels_;
            return true;
        }
        if (line_pixels_ && line_pixels_ != WIDTH) return fail("a line of the wrong length");
        line_pixels_ = 0;
        if (red | green | blue) return fail("colour during blanking");
        return true;
    }
    // The machine was reset: its scans begin anew.
    void restart() {
        pixels_.clear();
        line_pixels_ = 0;
        synchronised_ = in_sync_ = false;
    }
    bool shown_since(uint64_t cycle) const { return scans_ && last_scan_cycle_ > cycle; }
    const char* failure() const { return failure_; }

  private:
    bool fail(const char* why) { failure_ = why; return false; }
    bool finish() {
        if (synchronised_) {
            if (pixels_.size() != 3ull * WIDTH * HEIGHT) return fail("a scan of the wrong size");
            std::fputc(RecordKind::SCAN, results_);
            std::fwrite(&first_cycle_, sizeof first_cycle_, 1, results_);
            std::fwrite(pixels_.data(), 1, pixels_.size(), results_);
            last_scan_cycle_ = first_cycle_;
            ++scans_;
        }
        synchronised_ = true;
        pixels_.clear();
        return true;
    }
    FILE* results_;
    std::vector<uint8_t> pixels_;
    uint64_t line_pixels_ = 0, first_cycle_ = 0, last_scan_cycle_ = 0, scans_ = 0;
    bool synchronised_ = false, in_sync_ = false;
    const char* failure_ = "";
};

#if OBSERVED_ELEMENTS
// Counts what each processing element does, in buckets that double while the record grows.
class Watch {
  public:
    explicit Watch(FILE* results) : results_(results) {}

    // An opcode is taken and a response given in this clock, unless 0.
    void clock(uint64_t cycle, const Vmachine& machine, uint8_t opcode, uint8_t response) {
        if (opcode == Opcode::READ_COUNTERS) {
            end();
        } else if (!watching_ && DRAWING_OPCODES >> opcode & 1) {
            watching_ = true;
            begin_ = cycle;
            clocks_ = 0;
            width_ = 1;
            std::memset(counts_, 0, sizeof counts_);
        }
        if (!watching_) return;
        if (clocks_ == BUCKETS * width_) halve();
        auto& bucket = counts_[clocks_++ / width_];
        for (unsigned element = 0; element < OBSERVED_ELEMENTS; ++element)
            ++bucket[element][field(machine.activity, element * ACTIVITY_BITS)];
        if (response == ResponseKind::FRAME_DRAWN) end();
    }

  private:
    static constexpr unsigned KINDS = 1 << ACTIVITY_BITS;

    template <typename Word> static unsigned field(const Word& word, unsigned bit) {
        return static_cast<unsigned>(word >> bit) & (KINDS - 1);
    }
    template <std::size_t Words>
    static unsigned field(const VlWide<Words>& word, unsigned bit) {
        return word.at(bit / 32) >> bit % 32 & (KINDS - 1);  // no field crosses a word
    }
    void halve() {
        uint32_t* const counts = &counts_[0][0][0];
        constexpr unsigned SIZE = OBSERVED_ELEMENTS * KINDS;
        for (unsigned bucket = 0; bucket < BUCKETS; ++bucket)
            for (unsigned place = 0; place < SIZE; ++place) {
                const uint32_t count = counts[bucket * SIZE + place];
                counts[bucket * SIZE + place] = 0;
                counts[bucket / 2 * SIZE + place] += count;
            }
        width_ *= 2;
    }
    void end() {
        if (!watching_) return;
        watching_ = false;
        const uint64_t buckets = (clocks_ + width_ - 1) / width_;
        std::fputc(RecordKind::ACTIVITY, results_);
        for (const uint64_t value : {begin_, clocks_, width_, buckets})
            std::fwrite(&value, sizeof value, 1, results_);
        std::fwrite(counts_, sizeof counts_[0], buckets, results_);
    }
    FILE* results_;
    bool watching_ = false;
    uint64_t begin_ = 0, clocks_ = 0, width_ = 1;
    uint32_t counts_[BUCKETS][OBSERVED_ELEMENTS][KINDS];
};
#else
class Watch {
  public:
    explicit Watch(FILE*) {}
    void clock(uint64_t, const Vmachine&, uint8_t, uint8_t) {}
};
#endif

// The host's commands, one after another as they come; all are kept only for a host that may have
// to go back.
class Commands {
  public:
    explicit Commands(bool goes_back) : goes_back_(goes_back) {}

    // The words of a command: of the next one, of an earlier one where the host goes back; null
    // after the last one.
    const uint32_t* words(uint64_t number) {
        while (number >= read_) {
            const size_t place = goes_back_ ? words_.size() : 0;
            words_.resize(place + COMMAND_WORDS);
            if (std::fread(&words_[place], 4, COMMAND_WORDS, stdin) != COMMAND_WORDS) {
                words_.resize(place);
                return nullptr;
            }
            ++read_;
        }
        return &words_[goes_back_ ? number * COMMAND_WORDS : 0];
    }

  private:
    const bool goes_back_;
    std::vector<uint32_t> words_;
    uint64_t read_ = 0;
};

int bare(VerilatedContext& context, Vmachine& machine, uint64_t cycles) {
    const auto began = std::chrono::steady_clock::now();
    for (uint64_t cycle = 0; cycle < cycles; ++cycle) {
        machine.clk = 0;
        machine.eval();
        machine.clk = 1;
        machine.eval();
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
    std::printf("%f\n", seconds.count());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    VerilatedContext context;
    const bool is_bare = argc == 3 && !std::strcmp(argv[1], "bare");
    if (!is_bare && (argc < 6 || argc % 2 == 1)) { std::fprintf(stderr, "wrong arguments\n"); return 2; }
    const int64_t memory_seed = is_bare ? -1 : std::atoll(argv[3]);
    if (memory_seed >= 0) {
        context.randReset(2);
        context.randSeed(static_cast<int>(memory_seed % 0x7fffffff) + 1);
    }
    const auto owner = std::make_unique<Vmachine>(&context);
    Vmachine& machine = *owner;
    machine.rst = 0;
    if (is_bare) return bare(context, machine, std::strtoull(argv[2], nullptr, 10));

    FILE* results = std::fopen(argv[1], "wb");
    if (!results) { std::perror(argv[1]); return 2; }
    const uint64_t expected = std::strtoull(argv[2], nullptr, 10);
    const int64_t stall_seed = std::atoll(argv[4]);
    const uint64_t maximum = std::strtoull(argv[5], nullptr, 10);

    struct Reset { uint64_t cycle, command; };
    std::vector<Reset> resets;
    for (int place = 6; place < argc; place += 2)
        resets.push_back({std::strtoull(argv[place], nullptr, 10),
                          std::strtoull(argv[place + 1], nullptr, 10)});
    auto reset = resets.begin();

    Pace send(stall_seed, 0), receive(stall_seed, 1);
    Monitor monitor(results);
    const auto watch = std::make_unique<Watch>(results);
    std::vector<uint64_t> accepted;
    Commands commands(!resets.empty());
    const uint32_t* words = nullptr;  // of the command after the one that is offered
    bool offers = false;
    uint8_t opcode = 0;
    uint64_t sent = 0, received = 0, cycle = 0, shown_cycle = 0;  // the first two since a reset
    bool shown = false;
    char why = End::MAXIMUM;
    const char* reason = "";

    const auto next_command = [&] {
        offers = words;
        if (!offers) { send.stop(); return; }
        std::memcpy(&machine.PORT(commands, payload), words, 4 * COMMAND_WORDS);
        opcode = *words & OPCODE_MASK;
        words = commands.words(sent + 1);
        send.go();
    };
    words = commands.words(0);
    next_command();
    receive.go();
    while (maximum == 0 || cycle <= maximum) {
        const bool resetting = reset != resets.end() && reset->cycle == cycle + 1;
        machine.clk = 0;
        machine.rst = resetting;
        machine.PORT(commands, valid) = send.high();
        machine.PORT(responses, ready) = receive.high();
        machine.eval();
        // What the clock edge will take, and what it shows now.
        const bool taken = send.high() && machine.PORT(commands, ready);
        const bool given = receive.high() && machine.PORT(responses, valid);
        const uint64_t response = machine.PORT(responses, payload);
        ++cycle;
        watch->clock(cycle, machine, taken ? opcode : 0, given ? response & KIND_MASK : 0);
        bool finished = false;
        if (machine.PORT(pins, pixel)) {
            if (!monitor.sample(cycle, machine.PORT(pins, active), machine.PORT(pins, vertical_sync),
                                machine.PORT(pins, red), machine.PORT(pins, green), machine.PORT(pins, blue))) {
                why = End::VIDEO;
                reason = monitor.failure();
                break;
            }
            finished = reset == resets.end() && (taken ? !words : !offers)
                       && received + given >= expected && (!shown || monitor.shown_since(shown_cycle));
        }
        machine.clk = 1;
        machine.eval();
        if (taken) { accepted.push_back(cycle); ++sent; next_command(); } else send.wait();
        if (given) {
            const uint8_t kind = response & KIND_MASK;
            const uint32_t value = static_cast<uint32_t>(response >> RESPONSE_KIND_BITS);
            std::fputc(RecordKind::RESPONSE, results);
            std::fputc(kind, results);
            std::fwrite(&value, sizeof value, 1, results);
            std::fwrite(&cycle, sizeof cycle, 1, results);
            ++received;
            if (kind == ResponseKind::FRAME_SHOWN) { shown = true; shown_cycle = cycle; }
            receive.go();
        } else receive.wait();
        if (resetting) {  // what was sent and received before is of no account
            sent = (reset++)->command;
            received = 0;
            shown = false;
            monitor.restart();
            words = commands.words(sent);
            next_command();
        }
        if (cycle % PROGRESS_CYCLES == 0) {
            std::printf("%llu %llu\n", static_cast<unsigned long long>(cycle),
                        static_cast<unsigned long long>(received));
            std::fflush(stdout);
        }
        if (finished) { why = End::DONE; break; }
    }
    const uint64_t taken = accepted.size();
    std::fputc(RecordKind::COMMANDS, results);
    std::fwrite(&taken, sizeof taken, 1, results);
    std::fwrite(accepted.data(), sizeof taken, taken, results);
    std::fputc(RecordKind::END, results);
    std::fputc(why, results);
    std::fwrite(&cycle, sizeof cycle, 1, results);
    std::fputs(reason, results);
    const bool failed = std::ferror(results);
    if (std::fclose(results) || failed) { std::perror(argv[1]); return 2; }  // a full disk
    machine.final();
    return 0;
}
