// Host and screen of a Cardcage machine, whichever model it is linked with.
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

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "verilator_model.h"

// What Python knows of the words and the results; model_constants.py writes it.
#include "model_constants.h"

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
    Monitor(FILE* results, const MachineNumbers& machine) : results_(results), machine_(machine) {
        pixels_.reserve(scan_bytes());
    }

    // False, with a reason, when the video is malformed.
    bool sample(uint64_t cycle, bool active, bool vertical_sync, uint8_t red, uint8_t green,
                uint8_t blue) {
        const bool in_sync = vertical_sync == machine_.vertical_sync_positive;
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
        if (line_pixels_ && line_pixels_ != machine_.width) return fail("a line of the wrong length");
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
    size_t scan_bytes() const { return size_t{3} * machine_.width * machine_.height; }
    bool fail(const char* why) { failure_ = why; return false; }
    bool finish() {
        if (synchronised_) {
            if (pixels_.size() != scan_bytes()) return fail("a scan of the wrong size");
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
    const MachineNumbers& machine_;
    std::vector<uint8_t> pixels_;
    uint64_t line_pixels_ = 0, first_cycle_ = 0, last_scan_cycle_ = 0, scans_ = 0;
    bool synchronised_ = false, in_sync_ = false;
    const char* failure_ = "";
};

// Counts what each processing element does, in buckets that double while the record grows.
class Watch {
  public:
    Watch(FILE* results, const Model& model)
        : results_(results), model_(model), elements_(model.numbers.observed_elements),
          counts_(size_t{BUCKETS} * elements_ * KINDS) {}

    // An opcode is taken and a response given in this clock, unless 0.
    void clock(uint64_t cycle, uint8_t opcode, uint8_t response) {
        if (!elements_) return;
        if (opcode == Opcode::READ_COUNTERS) {
            end();
        } else if (!watching_ && DRAWING_OPCODES >> opcode & 1) {
            watching_ = true;
            begin_ = cycle;
            clocks_ = 0;
            width_ = 1;
            std::fill(counts_.begin(), counts_.end(), 0);
        }
        if (!watching_) return;
        if (clocks_ == BUCKETS * width_) halve();
        uint32_t* bucket = &counts_[clocks_++ / width_ * elements_ * KINDS];
        for (unsigned bit = 0; bit < elements_ * ACTIVITY_BITS; bit += ACTIVITY_BITS, bucket += KINDS)
            ++bucket[model_.activity[bit / 8] >> bit % 8 & (KINDS - 1)];
        if (response == ResponseKind::FRAME_DRAWN) end();
    }

  private:
    static constexpr unsigned KINDS = 1 << ACTIVITY_BITS;
    static_assert(8 % ACTIVITY_BITS == 0, "no field crosses a byte");

    void halve() {
        const size_t size = size_t{elements_} * KINDS;
        for (size_t bucket = 0; bucket < BUCKETS; ++bucket)
            for (size_t place = 0; place < size; ++place) {
                const uint32_t count = counts_[bucket * size + place];
                counts_[bucket * size + place] = 0;
                counts_[bucket / 2 * size + place] += count;
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
        std::fwrite(counts_.data(), sizeof counts_[0] * elements_ * KINDS, buckets, results_);
    }
    FILE* results_;
    const Model& model_;
    const unsigned elements_;
    bool watching_ = false;
    uint64_t begin_ = 0, clocks_ = 0, width_ = 1;
    std::vector<uint32_t> counts_;
};

// The host's commands, one after another as they come; all are kept only for a host that may have
// to go back.
class Commands {
  public:
    Commands(unsigned size, bool goes_back) : size_(size), goes_back_(goes_back) {}

    // The words of a command: of the next one, of an earlier one where the host goes back; null
    // after the last one.
    const uint32_t* words(uint64_t number) {
        while (number >= read_) {
            const size_t place = goes_back_ ? words_.size() : 0;
            words_.resize(place + size_);
            if (std::fread(&words_[place], 4, size_, stdin) != size_) {
                words_.resize(place);
                return nullptr;
            }
            ++read_;
        }
        return &words_[goes_back_ ? number * size_ : 0];
    }

  private:
    const size_t size_;
    const bool goes_back_;
    std::vector<uint32_t> words_;
    uint64_t read_ = 0;
};

int bare(Model& model, uint64_t cycles) {
    model.settle();
    const auto began = std::chrono::steady_clock::now();
    for (uint64_t cycle = 0; cycle < cycles; ++cycle) model.clock();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
    std::printf("%f\n", seconds.count());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const bool is_bare = argc == 3 && !std::strcmp(argv[1], "bare");
    if (!is_bare && (argc < 6 || argc % 2 == 1)) { std::fprintf(stderr, "wrong arguments\n"); return 2; }
    const int64_t memory_seed = is_bare ? -1 : std::atoll(argv[3]);
    const std::unique_ptr<Model> owner = make_model(memory_seed);
    Model& model = *owner;
    if (is_bare) return bare(model, std::strtoull(argv[2], nullptr, 10));

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
    Monitor monitor(results, model.numbers);
    Watch watch(results, model);
    std::vector<uint64_t> accepted;
    Commands commands(model.numbers.command_words, !resets.empty());
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
        std::memcpy(model.commands_payload, words, 4 * model.numbers.command_words);
        opcode = *words & OPCODE_MASK;
        words = commands.words(sent + 1);
        send.go();
    };
    bool resetting = false;  // at the next clock edge
    const auto set_inputs = [&] {
        resetting = reset != resets.end() && reset->cycle == cycle + 1;
        *model.rst = resetting;
        *model.commands_valid = send.high();
        *model.responses_ready = receive.high();
    };
    words = commands.words(0);
    next_command();
    receive.go();
    set_inputs();
    model.settle();
    while (maximum == 0 || cycle <= maximum) {
        // What the next clock edge will take, and what the machine shows until then.
        const bool taken = send.high() && *model.commands_ready;
        const bool given = receive.high() && *model.responses_valid;
        const uint64_t response = *model.responses_payload;
        ++cycle;
        watch.clock(cycle, taken ? opcode : 0, given ? response & KIND_MASK : 0);
        bool finished = false;
        if (*model.pixel) {
            if (!monitor.sample(cycle, *model.active, *model.vertical_sync, *model.red, *model.green,
                                *model.blue)) {
                why = End::VIDEO;
                reason = monitor.failure();
                break;
            }
            finished = reset == resets.end() && (taken ? !words : !offers)
                       && received + given >= expected && (!shown || monitor.shown_since(shown_cycle));
        }
        // What the machine gets after that edge.
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
        set_inputs();
        model.clock();
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
    model.finish();
    return 0;
}
