#include "echopath/signal/kernels.h"

#include "echopath/base/simd.h"

namespace echopath {

namespace kernels_baseline { extern const SignalKernels kKernels; }
#ifdef ECHOPATH_X86_KERNELS
namespace kernels_avx2 { extern const SignalKernels kKernels; }
namespace kernels_avx512 { extern const SignalKernels kKernels; }
#endif

const SignalKernels& signal_kernels() {
#ifdef ECHOPATH_X86_KERNELS
  if (instruction_set() == InstructionSet::kAvx512) return kernels_avx512::kKernels;
  if (instruction_set() == InstructionSet::kAvx2) return kernels_avx2::kKernels;
#endif
  return kernels_baseline::kKernels;
}

}  // namespace echopath
