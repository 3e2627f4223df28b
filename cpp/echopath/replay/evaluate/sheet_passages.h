#pragma once
// Puts what sheets do to the paths that go through them (Paths::passes) to lengths and amplitudes that are evaluated as if
// there were no sheets.
//
// A leg crosses the plane of the triangle in which it was recorded wherever that is at the time, or the curved surface that
// this stands for. The amplitude takes the transmission of the sheet (em/sheet_model.h), and the length its delay: the phase
// of the transmission at the start frequency belongs to both together.
#include <optional>
#include <vector>

#include "echopath/em/sheet_table.h"
#include "echopath/replay/evaluate/shared_legs.h"

namespace echopath {

class SheetPassages {
 public:
  // Serves the record of the preparer, which must outlive it, played back at this wavelength (m). Raises invalid_argument.
  SheetPassages(const PathPreparer& preparer, double wavelength);
  // Changes what was written for these paths, in the order of the places.
  void apply(std::span<const int64_t> indices, const PosedNodes& nodes, const ChannelSpan& channels) const;

 private:
  class OfPath;
  struct Sheet {
    SheetModel model;
    std::optional<SheetTable> table;  // where there are many passes

    SheetPassage passage(double cos_incidence) const {
      return table ? table->passage(cos_incidence) : model.passage(cos_incidence);
    }
  };
  const PathPreparer& preparer_;
  double wavelength_;                          // m
  Vec3 polarization_ = Vec3::UnitZ();          // of the wave, by which its modes are told apart
  std::vector<std::optional<Sheet>> of_mesh_;  // by mesh ID; empty where no path passes a sheet
};

}  // namespace echopath
