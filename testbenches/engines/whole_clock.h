// A clock of a machine that is one Verilated model, with a register before each of its inputs.

#pragma once

#include "Vmodel.h"

class Clocked {
  public:
    explicit Clocked(VerilatedContext& context) : machine(&context) {}
    void settle() { machine.eval(); }
    void clock() {
        machine.clk = 0;
        machine.eval();
        machine.clk = 1;
        machine.eval();
    }
    Vmodel machine;
};
