// The ports of a machine as verilator_model.h names them; compiled with each machine.

#include "verilator_model.h"

#include "clock.h"  // whole_clock.h or split_clock.h
#include "machine_numbers.h"  // model_wrapper.py writes it

namespace {

// Verilator writes the second underscore of a port's name as its code.
#define PORT(interface, member) clocked_.machine.interface##___05F##member

class CompiledModel final : public Model {
  public:
    explicit CompiledModel(int64_t memory_seed)
        : Model(NUMBERS), context_(memory_seed), clocked_(context_) {
        rst = &clocked_.machine.rst;
        commands_valid = &PORT(commands, valid);
        commands_payload = &PORT(commands, payload);
        commands_ready = &PORT(commands, ready);
        responses_valid = &PORT(responses, valid);
        responses_payload = &PORT(responses, payload);
        responses_ready = &PORT(responses, ready);
        pixel = &PORT(pins, pixel);
        active = &PORT(pins, active);
        vertical_sync = &PORT(pins, vertical_sync);
        red = &PORT(pins, red);
        green = &PORT(pins, green);
        blue = &PORT(pins, blue);
        activity = reinterpret_cast<const uint8_t*>(&clocked_.machine.activity);
    }
    void settle() override { clocked_.settle(); }
    void clock() override { clocked_.clock(); }
    void finish() override { clocked_.machine.final(); }

  private:
    struct Context : VerilatedContext {
        explicit Context(int64_t memory_seed) {
            if (memory_seed < 0) return;
            randReset(2);
            randSeed(static_cast<int>(memory_seed % 0x7fffffff) + 1);
        }
    };
    Context context_;
    Clocked clocked_;
};

}  // namespace

std::unique_ptr<Model> make_model(int64_t memory_seed) {
    return std::make_unique<CompiledModel>(memory_seed);
}
