#include "echopath/base/simd.h"
#ifdef ECHOPATH_X86_KERNELS
#define ECHOPATH_KERNELS kernels_avx512
#define ECHOPATH_LANES 8
#include "echopath/signal/kernels_body.h"
#endif
