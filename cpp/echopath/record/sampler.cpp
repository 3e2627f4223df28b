#include "echopath/record/sampler.h"

namespace echopath {

double footprint_spread(Sampler sampler) {
  switch (sampler) {
    case Sampler::kLattice: return 0.65;
    case Sampler::kFibonacci: return 0.6;
    case Sampler::kR2: return 0.95;
    case Sampler::kRandom: break;
  }
  return 1.2;
}

}  // namespace echopath
