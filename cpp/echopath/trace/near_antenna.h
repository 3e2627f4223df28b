#pragma once

namespace echopath {

inline constexpr double kNearAntenna = 1e-3;  // m: contributions nearer to an antenna are dropped

}  // namespace echopath
