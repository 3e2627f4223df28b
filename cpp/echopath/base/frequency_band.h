#pragma once

namespace echopath {

// Holds the ends of a band, Hz.
struct FrequencyBand {
  double lowest, highest;
};

}  // namespace echopath
