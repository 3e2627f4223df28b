#pragma once
// Sums over rows of powers, which only add: a strong echo leaves no rounding behind.
#include <cstdint>

#include "echopath/spectrum/cfar_factor/cfar_window.h"

namespace echopath {

// Writes values[i] + ... + values[i + width - 1] to sum[i] for each i for which all of them are among `count` values;
// nothing for a width of 0 or beyond `count`.
void moving_sums(const double* values, int64_t count, int64_t width, double* sum);

// Adds `count` values to sums.
void add_row(const double* values, int64_t count, double* sum);

// Returns the sum over a span of a row.
double span_sum(const double* row, CellSpan span);

}  // namespace echopath
