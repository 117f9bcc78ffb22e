// What the main program knows of a compiled machine: its numbers and its ports.
//
// The main program is compiled once on a computer, what is behind this with each machine.

#pragma once

#include <cstdint>
#include <memory>

// Numbers of a machine, as its configuration has them.
struct MachineNumbers {
    unsigned command_words, width, height;
    bool vertical_sync_positive;
    unsigned observed_elements;  // 0 where the machine is not observed
};

// What is written to an input is what the machine gets after the next clock edge, and before the first
// one at once.
struct Model {
    virtual ~Model() = default;
    virtual void settle() = 0;  // once, before the first clock
    virtual void clock() = 0;   // a clock, its rising edge last
    virtual void finish() = 0;

    const MachineNumbers numbers;

    uint8_t *rst, *commands_valid, *responses_ready;
    void* commands_payload;  // command_words of 32 bits
    const uint8_t *commands_ready, *responses_valid;
    const uint64_t* responses_payload;
    const uint8_t *pixel, *active, *vertical_sync, *red, *green, *blue;
    const uint8_t* activity;  // ACTIVITY_BITS for each element, the first in the lowest bits

  protected:
    explicit Model(const MachineNumbers& numbers) : numbers(numbers) {}
};

// The machine that this program was linked with; what its memories hold at power-on is random, by the
// seed, or nothing where that is negative.
std::unique_ptr<Model> make_model(int64_t memory_seed);
