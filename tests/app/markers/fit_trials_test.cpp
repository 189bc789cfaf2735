// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey fit` on trials that are wrong as a whole: left for right, another unit, another
// axis for up.
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/app/labelled_session.h"
#include "tests/support/bodies/labelled_wearer.h"
#include "tests/support/bodies/worn_markers.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

/// Exchanges L and R in front of the labels that `is_meant` picks.
void exchange_sides(MarkerTracks& tracks,
                    const std::function<bool(const std::string&)>& is_meant) {
  for (std::string& label : tracks.labels) {
    if (!is_meant(label)) continue;
    if (label[0] == 'L') {
      label[0] = 'R';
    } else if (label[0] == 'R') {
      label[0] = 'L';
    }
  }
}

bool is_of_the_legs(const std::string& label) {
  for (const char* part : {"THI", "KNE", "KNM", "TIB", "ANK", "MED", "HEE", "TOE"}) {
    if (label.find(part) == 1) return true;
  }
  return false;
}

bool is_of_the_arms(const std::string& label) {
  for (const char* part : {"UPA", "ELB", "FRM", "WRA", "WRB", "FIN"}) {
    if (label.find(part) == 1) return true;
  }
  return false;
}

/// Standing, range of motion and walk of one person, as they should be.
class Trials {
 public:
  Trials() : person_(labelled_person()), moving_(without_markers_inside(person_)) {
    tracks = {film_markers(person_, standing(person_), {40, 100.0, 3e-4}),
              film_markers(moving_, range_of_motion(moving_), {200, 100.0, 3e-4}),
              film_markers(moving_, walking(moving_), {120, 100.0, 3e-4})};
  }

  /// `marey fit` of all three.
  ProgramRun run(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments;
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      const fs::path path = folder_ / (std::string(kNames.at(t)) + ".trc");
      write_tracks(path, tracks[t]);
      arguments.push_back(path.string());
    }
    arguments.insert(arguments.end(), {"--out", (folder_ / "out").string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return fit(arguments);
  }

  std::vector<MarkerTracks> tracks;

 private:
  static constexpr std::array<const char*, 3> kNames{"static", "range", "walk"};
  Body person_;
  Body moving_;
  ScratchFolder folder_;
};

/// The first error is about this file, and all of these words are in it.
void expect_named(const ProgramRun& run,
                  const std::string& file,
                  const std::vector<std::string>& words) {
  const std::size_t start = run.err.find("error: ");
  ASSERT_NE(start, std::string::npos) << run.err;
  const std::string line = run.err.substr(start, run.err.find('\n', start) - start);
  EXPECT_NE(line.find(file), std::string::npos) << run.err;
  for (const std::string& word : words) {
    EXPECT_NE(line.find(word), std::string::npos) << word << "\n" << run.err;
  }
}

TEST(FitTrials, AcceptsTrialsThatAgree) {
  Trials trials;
  const ProgramRun run = trials.run();
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

class ExchangedTrial : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ExchangedTrial, IsNamedWhenAllLabelsAreExchanged) {
  Trials trials;
  exchange_sides(trials.tracks[GetParam()], [](const std::string&) { return true; });
  const ProgramRun run = trials.run();
  EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4) << run.err;
  const std::array files{"static.trc", "range.trc", "walk.trc"};
  expect_named(run,
               files.at(GetParam()),
               {"left and right seem exchanged on all labels in this trial",
                "exchange left and right in all labels of this file"});
}

TEST_P(ExchangedTrial, IsNamedWhenTheLegsAreExchanged) {
  Trials trials;
  exchange_sides(trials.tracks[GetParam()], is_of_the_legs);
  const ProgramRun run = trials.run();
  EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4) << run.err;
  const std::array files{"static.trc", "range.trc", "walk.trc"};
  expect_named(run,
               files.at(GetParam()),
               {"left and right seem exchanged on the legs in this trial",
                "labels of the legs in this file"});
}

TEST_P(ExchangedTrial, IsNamedWhenTheArmsAreExchanged) {
  Trials trials;
  exchange_sides(trials.tracks[GetParam()], is_of_the_arms);
  const ProgramRun run = trials.run();
  EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4) << run.err;
  const std::array files{"static.trc", "range.trc", "walk.trc"};
  expect_named(run, files.at(GetParam()), {"exchanged on the arms in this trial"});
}

INSTANTIATE_TEST_SUITE_P(Each, ExchangedTrial, ::testing::Values(0U, 1U, 2U));

struct OtherUnit {
  double scale;      ///< Factor from mm to the unit of the file's numbers.
  const char* unit;  ///< The unit of the file's numbers.
};

class TrialInAnotherUnit : public ::testing::TestWithParam<OtherUnit> {};

TEST_P(TrialInAnotherUnit, IsNamedWithItsUnit) {
  for (const std::size_t trial : {0U, 2U}) {
    Trials trials;
    rescale(trials.tracks[trial], GetParam().scale);
    const ProgramRun run = trials.run();
    EXPECT_EQ(run.exit_code, 3) << run.err;
    expect_named(
        run,
        trial == 0 ? "static.trc" : "walk.trc",
        {"times as far apart as in", std::string("--unit ") + GetParam().unit + "`"});
  }
}

INSTANTIATE_TEST_SUITE_P(Units,
                         TrialInAnotherUnit,
                         ::testing::Values(OtherUnit{0.001, "m"},
                                           OtherUnit{0.1, "cm"},
                                           OtherUnit{1.0 / 25.4, "in"}));

TEST(FitTrials, AllInInchesForCentimetresAreAPersonTooSmall) {
  Trials trials;
  for (MarkerTracks& tracks : trials.tracks) rescale(tracks, 1.0 / 25.4);
  ProgramRun run = trials.run({"--unit", "cm"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  expect_named(run, "", {"0.7", "m tall", "--unit in"});
  run = trials.run({"--unit", "in"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

class WrongUp : public ::testing::TestWithParam<const char*> {};

TEST_P(WrongUp, IsNamedWithTheAxisThatIsUp) {
  Trials trials;
  const ProgramRun run = trials.run({"--up", GetParam()});
  EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4) << run.err;
  expect_named(run, "static.trc", {"is up by --up", "(--up +Y)"});
}

INSTANTIATE_TEST_SUITE_P(Axes, WrongUp, ::testing::Values("+X", "-X", "+Z", "-Z", "-Y"));

}  // namespace
}  // namespace marey::testing
