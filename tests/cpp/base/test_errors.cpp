#include "echopath/base/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cpp/support/expect_error.h"
#include "echopath/base/constants.h"
#include "echopath/base/text/nearest_names.h"

namespace echopath::test_errors {
namespace {

using Names = std::vector<std::string>;

// What `require` says of a number behind "got ".
template <class Value>
std::string said_of(const Value& value) {
  const std::string said = test::error_text([&] { require(false, "bandwidth", "must be positive", value); }),
                    before = "bandwidth: must be positive, got ";
  return said.starts_with(before) ? said.substr(before.size()) : "another message: " + said;
}

TEST(Require, NamesArgumentRuleAndValue) {
  EXPECT_NO_THROW(require(true, "bandwidth", "must be positive", 1.0));
  EXPECT_EQ(said_of(-0.1), "-0.1");
}

TEST(Require, SaysNumbersAsTheyWereTyped) {
  EXPECT_EQ(said_of(40e-6), "4e-05");
  EXPECT_EQ(said_of(1e300), "1e+300");
  EXPECT_EQ(said_of(1e12), "1000000000000");
  EXPECT_EQ(said_of(77e9), "77000000000");
  EXPECT_EQ(said_of(std::nan("")), "nan");
  EXPECT_EQ(said_of(-INFINITY), "-inf");
}

TEST(Require, SaysComplexNumbersAsTheyWereTyped) {
  EXPECT_EQ(said_of(std::complex<double>(4.0, 0.1)), "4+0.1j");
  EXPECT_EQ(said_of(std::complex<double>(-2.5, -1e-3)), "-2.5-0.001j");
}

TEST(Require, SaysAllDigitsThatTellANumberFromItsNeighbours) {
  EXPECT_EQ(said_of(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(said_of(std::nextafter(1.0, 2.0)), "1.0000000000000002");
}

TEST(NearestNames, OrdersByEditDistance) {
  // Edit distances from "kitten": sitten 1, sitting 3 (the textbook pair), wall 6.
  EXPECT_EQ(nearest_names("kitten", {"wall", "sitting", "sitten"}), (Names{"sitten", "sitting", "wall"}));
}

TEST(NearestNames, FindsTransposedMissingAndAddedLetters) {
  const Names names{"bandwidth", "num_chirps", "start_frequency"};
  EXPECT_EQ(nearest_names("bandwitdh", names, 1), Names{"bandwidth"});
  EXPECT_EQ(nearest_names("num_chirp", names, 1), Names{"num_chirps"});
  EXPECT_EQ(nearest_names("start__frequency", names, 1), Names{"start_frequency"});
}

TEST(NearestNames, OneInsertionDeletionOrReplacementComesBeforeTwo) {
  EXPECT_EQ(nearest_names("abc", {"xyc", "abcd", "ab", "abx"}), (Names{"abcd", "ab", "abx"}));
}

TEST(NearestNames, WhatTheWordBeginsComesFirst) {
  EXPECT_EQ(nearest_names("ped", {"bed", "pedestrian", "red"}, 2), (Names{"pedestrian", "bed"}));
}

TEST(NearestNames, OfAWrongPartAreTheOtherPartsOfItsWhole) {
  const Names parts = {"walker", "walker/leg_left", "parker/arms", "walker/arm_left", "walker/arm_right"};
  EXPECT_EQ(nearest_names("walker/arms", parts), (Names{"walker/arm_left", "walker/arm_right", "walker/leg_left"}));
}

// One edit, early in the last part: names that share more letters with the typo are further away.
TEST(NearestNames, OfATypoInAPartIsThePartWithFewestEdits) {
  const Names parts = {"street/post1", "street/pole", "street/police", "street/pedestrian", "street/parking"};
  EXPECT_EQ(nearest_names("street/poedestrian", parts, 1), Names{"street/pedestrian"});
}

TEST(NearestNames, OfAWordThatPartsHaveAreThoseParts) {
  const Names parts = {"car", "car/wheel", "car/wheel/front_left/tyre", "walker", "walker/arm_left", "walker/leg_left"};
  EXPECT_EQ(nearest_names("arm", parts, 1), Names{"walker/arm_left"});
  EXPECT_EQ(nearest_names("legs", parts, 1), Names{"walker/leg_left"});
  EXPECT_EQ(nearest_names("wheels", parts, 1), Names{"car/wheel"});
  EXPECT_EQ(nearest_names("*/wheels/*", parts, 1), Names{"car/wheel"});
  EXPECT_EQ(nearest_names("tyres", parts, 1), Names{"car/wheel/front_left/tyre"});
  EXPECT_EQ(nearest_names("cat", parts, 1), Names{"car"});
}

TEST(NearestNames, KeepsTheGivenOrderAmongEquals) { EXPECT_EQ(nearest_names("x", {"b", "a", "c"}), (Names{"b", "a", "c"})); }

TEST(NearestNames, GivesAtMostTheCountAskedFor) {
  EXPECT_EQ(nearest_names("a", {"a", "b", "c"}, 2).size(), 2u);
  EXPECT_EQ(nearest_names("a", {"a"}, 5), Names{"a"});
  EXPECT_TRUE(nearest_names("a", {}).empty());
}

TEST(Constants, VacuumImpedanceFollowsFromThem) {
  // CODATA 2018: 376.730313668 ohm; eps0 is given with eleven digits.
  constexpr double kTolerance = 1e-7;
  EXPECT_NEAR(1.0 / (kVacuumPermittivity * kSpeedOfLight), 376.730313668, kTolerance);
}

}  // namespace
}  // namespace echopath::test_errors
