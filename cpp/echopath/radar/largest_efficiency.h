#pragma once

namespace echopath {

// Bounds the mean power gain over the sphere that an antenna may have: no antenna radiates more power than it is fed. The
// excess over 1 is noise of tables.
inline constexpr double kLargestEfficiency = 1.02;

}  // namespace echopath
