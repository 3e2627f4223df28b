#pragma once
// The virtual array of a MIMO radar has one element for each transmitter and receiver, at the sum of their positions.
#include <optional>
#include <utility>
#include <vector>

#include "echopath/base/geometry.h"
#include "echopath/radar/radar.h"

namespace echopath {

// Channels whose positions differ by less than this share of a wavelength are one element, and elements that lie within
// it of a grid's points are on the grid: a phase of 0.06 rad at most.
inline constexpr double kArrayTolerance = 0.01;

struct VirtualElement {
  Vec3 position = Vec3::Zero();  // m, in the radar's frame, mean over its channels
  std::vector<int> channels;     // tx * num_receivers + rx, ascending; several where channels overlap
  int row = 0, column = 0;       // place in the grid, where there is one
};

// Describes a rectangular grid of equal steps. One row is a line of columns; one column is a line of rows.
struct ArrayGrid {
  int num_rows = 1, num_columns = 1;
  Vec3 column_axis = Vec3::UnitY();  // unit, along which columns count up: the more horizontal one, to the left
  Vec3 row_axis = Vec3::UnitZ();     // unit, perpendicular to it, along which rows count up: upwards
  double column_spacing = 0.0;       // m, 0 for one column
  double row_spacing = 0.0;          // m, 0 for one row
  Vec3 origin = Vec3::Zero();        // m, of row 0 and column 0
  double deviation = 0.0;            // m, largest distance of an element from its point of the grid
};

struct VirtualArray {
  int num_transmitters = 0, num_receivers = 0;
  double wavelength = 0.0;               // m, at the centre frequency
  std::vector<Vec3> positions;           // [tx, rx] m, x_tx + x_rx in the radar's frame
  std::vector<VirtualElement> elements;  // by row and column; without a grid by their first channels
  std::optional<ArrayGrid> grid;         // none: the elements are on no line or rectangle of equal steps
  double boresight = 0.0;                // rad, mean azimuth of the antennas' boresights in the radar's frame

  Vec3 centre() const;  // m, mean of the elements: where phases are referred to
  // Returns the (row, column) of grid points without an element; empty without a grid.
  std::vector<std::pair<int, int>> gaps() const;
  int num_overlaps() const;  // channels beyond the first of each element
  Vec3 extent() const;       // m, largest differences of positions along x, y, z
};

// Returns the virtual array of a radar's antennas. A path's length falls by x.u when an antenna moves by x toward the unit
// direction u of a target, so a pair of antennas receives the phase of one that sits at x_tx + x_rx.
// The grid's axes are the horizontal and the upward direction in the plane of the elements where these fit, otherwise those
// of two elements that need the fewest points. Steps must be at least a fifth of a wavelength, and the grid has at most 16
// times as many points as elements along each axis.
VirtualArray virtual_array(const Radar& radar);

// Makes the elements and the grid of an array from its positions and its wavelength.
void arrange_elements(VirtualArray& array);

}  // namespace echopath
