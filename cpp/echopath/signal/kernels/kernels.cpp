#include "echopath/signal/kernels/kernels.h"

namespace echopath {

const SignalKernels& signal_kernels() { return kernels<SignalKernels>(); }

}  // namespace echopath
