#include "echopath/replay/kernels/chain_kernels.h"

#include "echopath/base/simd.h"
#include "echopath/replay/kernels/direct_kernels.h"

namespace echopath {

namespace chain_kernels_baseline {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels, kDirectKernelsOfOne;
}
#ifdef ECHOPATH_X86_KERNELS
namespace chain_kernels_avx2 {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels, kDirectKernelsOfOne;
}
namespace chain_kernels_avx512 {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels, kDirectKernelsOfOne;
}
#endif

namespace {

// Holds the kernels of instruction_set().
struct KernelsOfSet {
  const ChainKernels &chains, &chains_of_one;
  const DirectKernels &direct, &direct_of_one;
};

#define ECHOPATH_KERNELS_OF(set) KernelsOfSet{set::kKernels, set::kKernelsOfOne, set::kDirectKernels, set::kDirectKernelsOfOne}
KernelsOfSet kernels_of_set() {
#ifdef ECHOPATH_X86_KERNELS
  if (instruction_set() == InstructionSet::kAvx512) return ECHOPATH_KERNELS_OF(chain_kernels_avx512);
  if (instruction_set() == InstructionSet::kAvx2) return ECHOPATH_KERNELS_OF(chain_kernels_avx2);
#endif
  return ECHOPATH_KERNELS_OF(chain_kernels_baseline);
}
#undef ECHOPATH_KERNELS_OF

}  // namespace

const ChainKernels& chain_kernels(size_t stride) {
  const KernelsOfSet kernels = kernels_of_set();
  return stride == 1 ? kernels.chains_of_one : kernels.chains;
}

const ChainKernels& chain_kernels_of_one() { return kernels_of_set().chains_of_one; }

const DirectKernels& direct_kernels(size_t stride) {
  const KernelsOfSet kernels = kernels_of_set();
  return stride == 1 ? kernels.direct_of_one : kernels.direct;
}

}  // namespace echopath
