#include "echopath/replay/kernels/shared_leg_kernels.h"

#include "echopath/base/lanes/simd.h"
#include "echopath/replay/kernels/single_bounce_kernels.h"

namespace echopath {
namespace {

template <class Kernels>
const Kernels& kernels_of(size_t stride) {
  const auto& all = kernels<ForRows<Kernels>>();
  return stride == 1 ? all.of_one : all.of_many;
}

}  // namespace

const SharedLegKernels& shared_leg_kernels(size_t stride) { return kernels_of<SharedLegKernels>(stride); }

const SharedLegKernels& shared_leg_kernels_of_one() { return kernels_of<SharedLegKernels>(1); }

const SingleBounceKernels& single_bounce_kernels(size_t stride) { return kernels_of<SingleBounceKernels>(stride); }

}  // namespace echopath
