#include "echopath/base/simd.h"
#ifdef ECHOPATH_X86_KERNELS
#define ECHOPATH_KERNELS chain_kernels_avx2
#define ECHOPATH_LANES 4
#include "echopath/replay/kernels/chain_kernels_body.h"
#include "echopath/replay/kernels/direct_kernels_body.h"
#endif
