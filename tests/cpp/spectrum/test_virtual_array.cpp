#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "echopath/spectrum/array/virtual_array.h"
#include "plane_waves.h"

namespace echopath::test_virtual_array {
namespace {

using testing::line;
using testing::radar_with;
constexpr double kRounding = 1e-15;   // m, of sums of positions of centimetres
constexpr double kTurned = 1e-12;     // of unit vectors and grids that were turned
constexpr double kAlong = 0.99;       // cosine: of one of several axes, not of another
constexpr double kMeanStep = 1.2e-7;  // m: of 85 steps, both of whose ends are rounded by 5 um
constexpr double kRounded = 5.1e-6;   // m: half of 10 um, and a little of the mean step
const double kHalf = 0.5 * testing::wavelength();

std::vector<int> columns_of(const VirtualArray& array) {
  std::vector<int> columns;
  for (const VirtualElement& element : array.elements) columns.push_back(element.column);
  return columns;
}

TEST(VirtualArray, PositionsAreSumsOfTransmitterAndReceiver) {
  const Radar radar = radar_with({{0, 0.1, 0}, {0.3, 0, 1}}, {{0, 0, 2}, {0, 0.02, 0}, {0.5, 0, 0}});
  const VirtualArray array = virtual_array(radar);
  ASSERT_EQ(array.positions.size(), 6u);
  for (int tx = 0; tx < 2; ++tx) {
    for (int rx = 0; rx < 3; ++rx) {
      EXPECT_EQ(array.positions[tx * 3 + rx], Vec3(radar.transmitters[tx].position + radar.receivers[rx].position));
    }
  }
}

TEST(VirtualArray, ThreeTimesFourIsALineOfTwelve) {
  const Vec3 step(0, kHalf, 0), high(0, 0, 1);
  const VirtualArray array = virtual_array(radar_with(line(3, 4 * step, high), line(4, step, high)));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(array.grid->num_rows, 1);
  EXPECT_EQ(array.grid->num_columns, 12);
  EXPECT_NEAR(array.grid->column_spacing, kHalf, kRounding);
  EXPECT_NEAR((array.grid->column_axis - Vec3::UnitY()).norm(), 0.0, kRounding);
  EXPECT_LT(array.grid->deviation, kRounding);
  EXPECT_TRUE(array.gaps().empty());
  EXPECT_EQ(array.num_overlaps(), 0);
  EXPECT_NEAR(array.centre().y(), 5.5 * kHalf, kRounding);
}

TEST(VirtualArray, ColumnsCountToTheLeftAndRowsUpWhateverTheOrderOfTheAntennas) {
  const VirtualArray array = virtual_array(radar_with({{0, 0, 0}, {0, 0, -kHalf}}, line(3, Vec3(0, -kHalf, 0))));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(array.grid->num_rows, 2);
  EXPECT_EQ(array.grid->num_columns, 3);
  EXPECT_GT(array.grid->column_axis.y(), kAlong);
  EXPECT_GT(array.grid->row_axis.z(), kAlong);
  const VirtualElement& first = array.elements.front();  // row 0, column 0: the lowest and rightmost
  EXPECT_EQ(first.channels, std::vector<int>{5});
  for (const VirtualElement& element : array.elements) {
    EXPECT_NEAR(element.position.y(), (element.column - 2) * kHalf, kRounding);
    EXPECT_NEAR(element.position.z(), (element.row - 1) * kHalf, kRounding);
  }
}

TEST(VirtualArray, OverlapsAreOneElementOfSeveralChannels) {
  const Vec3 step(0, kHalf, 0);
  const VirtualArray array = virtual_array(radar_with(line(2, 3 * step), line(4, step)));
  EXPECT_EQ(array.elements.size(), 7u);
  EXPECT_EQ(array.num_overlaps(), 1);
  EXPECT_EQ(array.elements[3].channels, (std::vector<int>{3, 4}));
  EXPECT_TRUE(array.gaps().empty());
}

TEST(VirtualArray, GapsAreThePointsOfTheGridWithoutAnElement) {
  // The minimum redundancy array of four: 0, 1, 4, 6.
  const VirtualArray array =
      virtual_array(radar_with({Vec3::Zero()}, {{0, 0, 0}, {0, kHalf, 0}, {0, 4 * kHalf, 0}, {0, 6 * kHalf, 0}}));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(columns_of(array), (std::vector<int>{0, 1, 4, 6}));
  EXPECT_EQ(array.gaps(), (std::vector<std::pair<int, int>>{{0, 2}, {0, 3}, {0, 5}}));
}

TEST(VirtualArray, TheStepIsTheLargestThatAllDistancesAreMultiplesOf) {
  const double d = 0.7 * testing::wavelength();
  const VirtualArray array = virtual_array(radar_with({Vec3::Zero()}, {{0, 0, 0}, {0, 2 * d, 0}, {0, 5 * d, 0}}));
  ASSERT_TRUE(array.grid);
  EXPECT_NEAR(array.grid->column_spacing, d, kRounding);
  EXPECT_EQ(array.grid->num_columns, 6);
}

TEST(VirtualArray, AVerticalLineHasRowsAndOneColumn) {
  const VirtualArray array = virtual_array(radar_with({Vec3::Zero()}, line(5, Vec3(0, 0, kHalf))));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(array.grid->num_rows, 5);
  EXPECT_EQ(array.grid->num_columns, 1);
  EXPECT_GT(array.grid->row_axis.z(), kAlong);
}

TEST(VirtualArray, TurnedGridsKeepTheirShape) {
  std::vector<Vec3> plane;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) plane.emplace_back(0.0, column * kHalf, 1.3 * row * kHalf);
  }
  const Quaternion turns[] = {Quaternion(Eigen::AngleAxisd(0.5, Vec3::UnitX())),   // rolled
                              Quaternion(Eigen::AngleAxisd(-0.2, Vec3::UnitY())),  // looking up
                              Quaternion(Eigen::AngleAxisd(1.1, Vec3::UnitZ()) * Eigen::AngleAxisd(0.3, Vec3::UnitX()))};
  for (const Quaternion& turn : turns) {
    std::vector<Vec3> turned;
    for (const Vec3& position : plane) turned.push_back(turn * position);
    const VirtualArray array = virtual_array(radar_with({{0.1, 0.2, 0.3}}, turned));
    ASSERT_TRUE(array.grid);
    EXPECT_EQ(array.grid->num_rows, 3);
    EXPECT_EQ(array.grid->num_columns, 4);
    EXPECT_NEAR((array.grid->column_axis - turn * Vec3::UnitY()).norm(), 0.0, kTurned);
    EXPECT_NEAR(array.grid->row_spacing, 1.3 * kHalf, kTurned);
  }
}

TEST(VirtualArray, PositionsRoundedToTenMicrometresAreStillOnTheGrid) {
  std::vector<Vec3> receivers;
  for (int i = 0; i < 86; ++i) receivers.emplace_back(0.0, std::round(i * kHalf * 1e5) * 1e-5, 0.0);
  const VirtualArray array = virtual_array(radar_with({Vec3::Zero()}, receivers));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(array.grid->num_columns, 86);
  EXPECT_NEAR(array.grid->column_spacing, kHalf, kMeanStep);
  EXPECT_LT(array.grid->deviation, kRounded);
  EXPECT_GT(array.grid->deviation, 0.2 * kRounded);
}

TEST(VirtualArray, ArraysWithoutEqualStepsHaveNoGrid) {
  EXPECT_FALSE(virtual_array(testing::circle_radar()).grid);
  const double h = kHalf;
  EXPECT_FALSE(virtual_array(radar_with({Vec3::Zero()}, {{0, 0, 0}, {h, 0, 0}, {0, h, 0}, {0, 0, h}})).grid);
  const std::vector<Vec3> golden = {{0, 0, 0}, {0, h, 0}, {0, 1.618034 * h, 0}, {0, 100 * h, 0}};
  EXPECT_FALSE(virtual_array(radar_with({Vec3::Zero()}, golden)).grid);
}

TEST(VirtualArray, OneChannelIsAGridOfOnePoint) {
  const VirtualArray array = virtual_array(radar_with({{0, 0, 1}}, {{0, 0.01, 1}}));
  ASSERT_TRUE(array.grid);
  EXPECT_EQ(array.grid->num_rows * array.grid->num_columns, 1);
  EXPECT_EQ(array.extent(), Vec3(0, 0, 0));
  EXPECT_THROW(virtual_array(Radar{}), std::invalid_argument);
}

TEST(DefaultAngles, CoverWhatTheArrayTellsApart) {
  const VirtualArray half = virtual_array(testing::line_radar(12));
  EXPECT_NEAR(default_azimuths(half).front(), -0.5 * kPi, 1e-7);  // the arcsine of one within a rounding
  EXPECT_EQ(default_azimuths(half).size(), 181u);
  EXPECT_EQ(default_elevations(half), std::vector<double>{0.0});
  const double d = testing::wavelength();  // unambiguous to +-30 degrees
  const VirtualArray whole = virtual_array(radar_with({Vec3::Zero()}, line(4, Vec3(0, d, 0))));
  EXPECT_NEAR(default_azimuths(whole).back(), kPi / 6.0, kTurned);
  const VirtualArray up = virtual_array(radar_with({Vec3::Zero()}, line(4, Vec3(0, 0, kHalf))));
  EXPECT_EQ(default_azimuths(up), std::vector<double>{0.0});
  EXPECT_NEAR(default_elevations(up).front(), -0.25 * kPi, kTurned);
}

TEST(DefaultAngles, OfALineThatIsNotLevelAreThoseOfAzimuthAlone) {
  for (const double roll : {0.001, 0.035, 0.5}) {
    const VirtualArray array =
        virtual_array(radar_with({Vec3::Zero()}, line(12, kHalf * Vec3(0, std::cos(roll), std::sin(roll)))));
    EXPECT_TRUE(tells_azimuths(array)) << roll;
    EXPECT_FALSE(tells_elevations(array)) << roll;  // all directions of a cone about the line have the same phases
    EXPECT_EQ(default_elevations(array), std::vector<double>{0.0});
  }
  const VirtualArray steep = virtual_array(radar_with({Vec3::Zero()}, line(12, kHalf * Vec3(0, 0.1, 0.9))));
  EXPECT_FALSE(tells_azimuths(steep));
  EXPECT_TRUE(tells_elevations(steep));
  const double step = 0.02 * testing::wavelength();  // as positions of antennas on a board may be off
  const VirtualArray uneven = virtual_array(
      radar_with({Vec3::Zero()}, {Vec3(0, 0, 0), Vec3(0, kHalf, step), Vec3(0, 2 * kHalf, 0), Vec3(0, 3 * kHalf, step)}));
  EXPECT_FALSE(tells_elevations(uneven));
  const VirtualArray corner =
      virtual_array(radar_with({Vec3::Zero()}, {Vec3(0, 0, 0), Vec3(0, kHalf, 0), Vec3(0, 0, kHalf)}));
  EXPECT_TRUE(tells_azimuths(corner) && tells_elevations(corner));
}

TEST(DefaultAngles, AreOnTheSideToWhichTheAntennasLook) {
  const auto middle = [](const Vec3& step, double yaw, int num_rows = 1) {
    Radar radar = radar_with(line(num_rows, Vec3(0, 0, kHalf)), line(8, step));
    for (auto* antennas : {&radar.transmitters, &radar.receivers}) {
      for (Antenna& antenna : *antennas) antenna.orientation = Eigen::AngleAxisd(yaw, Vec3::UnitZ());
    }
    const std::vector<double> azimuths = default_azimuths(virtual_array(radar));
    return 0.5 * (azimuths.front() + azimuths.back());
  };
  const Vec3 ahead(kHalf, 0, 0), left(0, kHalf, 0);
  EXPECT_NEAR(middle(ahead, 0.5 * kPi), 0.5 * kPi, kTurned);
  EXPECT_NEAR(middle(ahead, -1.2), -0.5 * kPi, kTurned);  // on that side, not aslant: +-90 degrees about the line's normal
  EXPECT_EQ(middle(left, 0.4), 0.0);
  EXPECT_EQ(middle(left, 0.4, 3), 0.0);
  EXPECT_NEAR(std::abs(middle(left, 3.0)), kPi, kTurned);
  EXPECT_EQ(middle(left, 0.0), 0.0);
  EXPECT_EQ(middle(ahead, 0.0), 0.0);  // along the line neither side is nearer
  EXPECT_NEAR(middle(kHalf * Vec3(-0.6, 0.8, 0), 0.0), std::atan2(0.6, 0.8), kTurned);
}

TEST(DefaultAngles, AreRefusedWhereThereWouldBeMillions) {
  const VirtualArray wide = virtual_array(radar_with({Vec3::Zero()}, {Vec3::Zero(), Vec3(0, kHalf, 0), Vec3(0, 1e4, 0)}));
  EXPECT_THROW(default_azimuths(wide), std::invalid_argument);
  EXPECT_FALSE(has_default_azimuths(wide));
  EXPECT_EQ(default_elevations(wide).size(), 1u);
}

TEST(DefaultAngles, OfAzimuthAreThereForAnArrayThatIsTooTallForThoseOfElevation) {
  const VirtualArray tall =
      virtual_array(radar_with({Vec3::Zero()}, {Vec3::Zero(), Vec3(0, kHalf, 0), Vec3(0, 0, kHalf), Vec3(0, 0, 1e4)}));
  EXPECT_TRUE(has_default_azimuths(tall));
  EXPECT_EQ(default_azimuths(tall).size(), 181u);
  EXPECT_THROW(default_elevations(tall), std::invalid_argument);
}

TEST(DefaultAngles, AreThereUpToTwoHundredThousand) {
  // Steps of a quarter of wavelength / extent up to 90 degrees: 100,000 of them are 25,000 / (pi / 2) wavelengths long.
  const double longest = 25'000.0 / (0.5 * kPi) * testing::wavelength();
  for (const double share : {0.999, 1.001}) {
    const VirtualArray array = virtual_array(
        radar_with({Vec3::Zero()}, {Vec3::Zero(), Vec3(0, share * longest, 0), Vec3(0, 0.3819 * share * longest, 0)}));
    EXPECT_EQ(has_default_azimuths(array), share < 1.0);
  }
}

TEST(SteeringVectors, AreRefusedWhereTheyWouldFillTheMemory) {
  const VirtualArray pair = virtual_array(radar_with({Vec3::Zero()}, line(2, Vec3(0, kHalf, 0))));
  const std::vector<double> axis(10'000, 0.0);
  EXPECT_THROW(beam_directions(pair, AngleGrid{axis, axis}), std::invalid_argument);
}

}  // namespace
}  // namespace echopath::test_virtual_array
