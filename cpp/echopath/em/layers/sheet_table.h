#pragma once
// Holds the passages of a sheet by angle, for where they are asked for again and again.
#include <array>
#include <vector>

#include "echopath/em/layers/sheet_model.h"

namespace echopath {

// Interpolates by cubics over the cosine of incidence, in steps in which phases within the sheet turn by 0.01 rad: it
// differs from the model by less than 1e-6 of the field.
class SheetTable {
 public:
  explicit SheetTable(const SheetModel& model);
  SheetPassage passage(double cos_incidence) const;

 private:
  using Row = std::array<double, 7>;  // te, tm, te_delay, tm_delay, offset
  std::vector<Row> rows_;             // at cosines from 0 to 1
};

}  // namespace echopath
