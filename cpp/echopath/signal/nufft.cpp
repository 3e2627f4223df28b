#include "echopath/signal/method.h"
namespace echopath {
std::unique_ptr<const ToneMethod> make_nufft(int num_samples, double) { return make_recurrence(num_samples); }
}  // namespace echopath
