#define ECHOPATH_KERNELS chain_kernels_baseline
#define ECHOPATH_LANES 2
#include "echopath/replay/kernels/chain_kernels_body.h"
#include "echopath/replay/kernels/direct_kernels_body.h"
