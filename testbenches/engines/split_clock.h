// A clock of a machine that is cut into cores, which hold all state, and a shell between them
// (domains/split_machine.py): the cores take what the shell puts out and step, and show it what they
// put out then; the shell is settled.

#pragma once

#include <array>
#include <memory>
#include <string>
#include <tuple>

#include "Vmodel.h"
#include "cores.h"  // their kinds; domains/core_texts.py writes it

// All cores of a kind.
template <typename Kind> class Cores {
  public:
    explicit Cores(VerilatedContext& context) {
        for (unsigned n = 0; n < Kind::COUNT; ++n)  // by its name each has its own random memories
            cores_[n] = std::make_unique<typename Kind::Core>(
                &context, (Kind::NAME + std::to_string(n)).c_str());
    }
    void settle() { for (auto& core : cores_) core->eval(); }
    void step(const Vmodel& shell) {
        for (unsigned n = 0; n < Kind::COUNT; ++n) {
            Kind::take(*cores_[n], shell, n);
            step_core(*cores_[n]);
        }
    }
    void show(Vmodel& shell) {
        for (unsigned n = 0; n < Kind::COUNT; ++n) Kind::show(*cores_[n], shell, n);
    }

  private:
    std::array<std::unique_ptr<typename Kind::Core>, Kind::COUNT> cores_;
};

template <typename Kinds> class AllCores;
template <typename... Kinds> class AllCores<std::tuple<Kinds...>> {
  public:
    explicit AllCores(VerilatedContext& context) : kinds_(Cores<Kinds>(context)...) {}
    void settle() { std::apply([](auto&... kind) { (kind.settle(), ...); }, kinds_); }
    void step(const Vmodel& shell) {
        std::apply([&](auto&... kind) { (kind.step(shell), ...); }, kinds_);
    }
    void show(Vmodel& shell) {
        std::apply([&](auto&... kind) { (kind.show(shell), ...); }, kinds_);
    }

  private:
    std::tuple<Cores<Kinds>...> kinds_;
};

class Clocked {
  public:
    explicit Clocked(VerilatedContext& context) : machine(&context), cores_(context) {}
    void settle() {
        cores_.settle();
        cores_.show(machine);
        machine.eval();
    }
    void clock() {
        cores_.step(machine);
        cores_.show(machine);
        machine.eval();
    }
    Vmodel machine;

  private:
    AllCores<Kinds> cores_;
};
