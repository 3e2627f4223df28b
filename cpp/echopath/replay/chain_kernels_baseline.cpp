#define ECHOPATH_KERNELS chain_kernels_baseline
#define ECHOPATH_LANES 2
#include "echopath/replay/chain_kernels_body.h"
#include "echopath/replay/direct_kernels_body.h"
