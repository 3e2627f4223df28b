#include "echopath/base/simd.h"
#ifdef ECHOPATH_X86_KERNELS
#define ECHOPATH_KERNELS chain_kernels_avx512
#define ECHOPATH_LANES 8
#include "echopath/replay/chain_kernels_body.h"
#include "echopath/replay/direct_kernels_body.h"
#endif
