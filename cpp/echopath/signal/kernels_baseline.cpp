#define ECHOPATH_KERNELS kernels_baseline
#define ECHOPATH_LANES 2
#include "echopath/signal/kernels_body.h"
