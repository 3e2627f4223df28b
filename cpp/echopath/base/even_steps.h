#pragma once
// Gives the steps of a sequence whose points are even in a square, however many of them are taken: multiples of both steps,
// modulo 1. Source: Roberts 2018, "The unreasonable effectiveness of quasirandom sequences" (R2).

namespace echopath {

inline constexpr double kEvenStep = 1.0 / 1.32471795724474602596;  // of the plastic number, x^3 = x + 1
inline constexpr double kOtherEvenStep = kEvenStep * kEvenStep;

}  // namespace echopath
