#include "echopath/base/lanes/simd.h"

#include <cstdlib>
#include <string>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

constexpr InstructionSet kAll[] = {InstructionSet::kBaseline, InstructionSet::kAvx2, InstructionSet::kAvx512};

bool machine_has(InstructionSet set) {
#ifdef ECHOPATH_X86_KERNELS
  __builtin_cpu_init();
  if (set == InstructionSet::kAvx512) return __builtin_cpu_supports("x86-64-v4");
  if (set == InstructionSet::kAvx2) return __builtin_cpu_supports("x86-64-v3");
#endif
  return set == InstructionSet::kBaseline;
}

InstructionSet best_set() {
  InstructionSet best = InstructionSet::kBaseline;
  for (const InstructionSet set : kAll) {
    if (machine_has(set)) best = set;
  }
  return best;
}

struct Choice {
  InstructionSet set;
  bool is_asked;
};

Choice choose() {
  const char* asked = std::getenv("ECHOPATH_INSTRUCTION_SET");
  if (!asked || !*asked) return {best_set(), false};
  for (const InstructionSet set : kAll) {
    if (std::string(asked) != name_of(set)) continue;
    require(machine_has(set), "ECHOPATH_INSTRUCTION_SET", "must be one that this machine has", asked);
    return {set, true};
  }
  require(false, "ECHOPATH_INSTRUCTION_SET", "must be baseline, avx2 or avx512", asked);
  return {InstructionSet::kBaseline, true};
}

// The environment is read once: what the program makes of it later must not change bits, and to read it while another
// thread sets a variable is a race.
const Choice& choice() {
  static const Choice made = choose();
  return made;
}

}  // namespace

InstructionSet instruction_set() { return choice().set; }

bool is_instruction_set_asked() { return choice().is_asked; }

const char* name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::kAvx512: return "avx512";
    case InstructionSet::kAvx2: return "avx2";
    case InstructionSet::kBaseline: break;
  }
  return "baseline";
}

}  // namespace echopath
