#include "echopath/replay/chain_kernels.h"

#include "echopath/base/simd.h"
#include "echopath/replay/direct_kernels.h"

namespace echopath {

namespace chain_kernels_baseline {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels;
}
#ifdef ECHOPATH_X86_KERNELS
namespace chain_kernels_avx2 {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels;
}
namespace chain_kernels_avx512 {
extern const ChainKernels kKernels, kKernelsOfOne;
extern const DirectKernels kDirectKernels;
}
#endif

const ChainKernels& chain_kernels(size_t stride) {
  const bool is_one = stride == 1;
#ifdef ECHOPATH_X86_KERNELS
  if (instruction_set() == InstructionSet::kAvx512) return is_one ? chain_kernels_avx512::kKernelsOfOne : chain_kernels_avx512::kKernels;
  if (instruction_set() == InstructionSet::kAvx2) return is_one ? chain_kernels_avx2::kKernelsOfOne : chain_kernels_avx2::kKernels;
#endif
  return is_one ? chain_kernels_baseline::kKernelsOfOne : chain_kernels_baseline::kKernels;
}

const DirectKernels& direct_kernels() {
#ifdef ECHOPATH_X86_KERNELS
  if (instruction_set() == InstructionSet::kAvx512) return chain_kernels_avx512::kDirectKernels;
  if (instruction_set() == InstructionSet::kAvx2) return chain_kernels_avx2::kDirectKernels;
#endif
  return chain_kernels_baseline::kDirectKernels;
}

}  // namespace echopath
