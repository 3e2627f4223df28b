#include "echopath/replay/kernels/chain_kernels.h"

#include "echopath/base/simd.h"
#include "echopath/replay/kernels/direct_kernels.h"

namespace echopath {
namespace {

template <class Kernels>
const Kernels& kernels_of(size_t stride) {
  const auto& all = kernels<ForRows<Kernels>>();
  return stride == 1 ? all.of_one : all.of_many;
}

}  // namespace

const ChainKernels& chain_kernels(size_t stride) { return kernels_of<ChainKernels>(stride); }

const ChainKernels& chain_kernels_of_one() { return kernels_of<ChainKernels>(1); }

const DirectKernels& direct_kernels(size_t stride) { return kernels_of<DirectKernels>(stride); }

}  // namespace echopath
