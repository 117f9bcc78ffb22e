// The ports of a machine as verilator_model.h names them; compiled with each machine.

#include "verilator_model.h"

#include "Vmodel.h"
#include "machine_numbers.h"  // model_wrapper.py writes it

namespace {

// Verilator writes the second underscore of a port's name as its code.
#define PORT(interface, member) machine_.interface##___05F##member

class CompiledModel final : public Model {
  public:
    explicit CompiledModel(int64_t memory_seed)
        : Model(NUMBERS), context_(memory_seed), machine_(&context_) {
        rst = &machine_.rst;
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
        activity = reinterpret_cast<const uint8_t*>(&machine_.activity);
    }
    void settle() override { machine_.eval(); }
    void clock() override {
        machine_.clk = 0;
        machine_.eval();
        machine_.clk = 1;
        machine_.eval();
    }
    void finish() override { machine_.final(); }

  private:
    struct Context : VerilatedContext {
        explicit Context(int64_t memory_seed) {
            if (memory_seed < 0) return;
            randReset(2);
            randSeed(static_cast<int>(memory_seed % 0x7fffffff) + 1);
        }
    };
    Context context_;
    Vmodel machine_;
};

}  // namespace

std::unique_ptr<Model> make_model(int64_t memory_seed) {
    return std::make_unique<CompiledModel>(memory_seed);
}
