// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey fit` on labels that are wrong, on statures that are, and on a jump over plates.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "recordings/base/atomic_file.h"
#include "tests/app/labelled_session.h"
#include "tests/support/bodies/labelled_wearer.h"
#include "tests/support/bodies/worn_markers.h"
#include "tests/support/program/paths.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kMocap = marey::testing::shared_data() / "mocap";

/// A standing trial, and a walk in which two labels are exchanged.
TEST(FitLabels, ProposesTheExchangeThatATrialNeeds) {
  const ScratchFolder folder;
  const Body person = labelled_person();
  write_tracks(folder / "static.c3d",
               film_markers(person, standing(person), {40, 100.0, 3e-4}));
  const Body moving = without_markers_inside(person);
  MarkerTracks walk = film_markers(moving, walking(moving), {120, 100.0, 3e-4});
  exchange(walk, "LTHI", "LKNE");
  write_tracks(folder / "walk.c3d", walk);
  const ProgramRun run = fit({(folder / "static.c3d").string(),
                              (folder / "walk.c3d").string(),
                              "--out",
                              (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("look exchanged"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("\"LTHI\""), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("\"LKNE\""), std::string::npos) << run.err;
}

TEST(FitLabels, RefusesAStatureThatAllMarkersContradict) {
  const ScratchFolder folder;
  const std::string file = write_static(folder, "static.c3d").string();
  const ProgramRun run =
      fit({file, "--stature", "1.45", "--out", (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("not the 1.45 m given"), std::string::npos) << run.err;
}

/// Subjects whose stature the files that came with their markers say.
struct Subject {
  const char* file;
  double stature_m;
};

void PrintTo(const Subject& subject, std::ostream* out) {
  *out << subject.file;
}

class KnownStatures : public ::testing::TestWithParam<Subject> {};

// Within two of the standard deviations reported.
TEST_P(KnownStatures, AreMeasuredFromTheMarkers) {
  const fs::path path = kMocap / GetParam().file;
  if (!fs::exists(path)) GTEST_SKIP() << path << " is not there";
  const ScratchFolder folder;
  const ProgramRun run = fit({path.string(), "--out", (folder / "out").string()});
  const auto json =
      nlohmann::json::parse(*recordings::read_file(folder / "out/fit.json"));
  ASSERT_TRUE(json["measured_stature_m"].is_number()) << run.err;
  const double sigma_m = json["stature_sigma_m"];
  EXPECT_LT(sigma_m, 0.05);
  EXPECT_NEAR(json["measured_stature_m"], GetParam().stature_m, 2.0 * sigma_m);
}

INSTANTIATE_TEST_SUITE_P(
    Mocap,
    KnownStatures,
    ::testing::Values(
        Subject{"opensim-models/Hamner/subject02_static.trc", 1.83},
        Subject{"opensim-models/Rajagopal/ExpData/static_walk_1.trc", 1.829},
        Subject{"opensim-core/Applications/Scale/tests/resources/subject01_static.trc",
                1.803},
        Subject{"nimblephysics/osim/LaiArnoldSubject5/DJ1.trc", 1.85}));

/// The numbers of one of numpy's arrays in an archive that is not compressed.
std::string array_of(const std::string& archive, const std::string& name) {
  const std::size_t entry = archive.find(name + ".npy");
  const std::size_t start = archive.find("\x93NUMPY", entry);
  if (entry == std::string::npos || start == std::string::npos) return {};
  // Zip's local header begins 30 bytes before the name. The entry's size is at byte 22.
  std::uint32_t size = 0;
  std::memcpy(&size, archive.data() + entry - 30 + 22, sizeof(size));
  std::uint16_t header = 0;
  std::memcpy(&header, archive.data() + start + 8, sizeof(header));
  return archive.substr(start + 10 + header, size - 10U - header);
}

// In this drop jump, the plates bear no load from 2.260 to 2.765 s. Contacts that ignore
// the flight of the centre of mass give 2.230 to 2.799 s.
TEST(FitLabels, ContactsOfAJumpAreThoseOfForcePlates) {
  const fs::path jump = kMocap / "nimblephysics/osim/LaiArnoldSubject5/DJ1.trc";
  if (!fs::exists(jump)) GTEST_SKIP() << jump << " is not there";
  const ScratchFolder folder;
  const ProgramRun run = fit({jump.string(), "--out", (folder / "out").string()});
  ASSERT_TRUE(fs::exists(folder / "out/DJ1/motion.npz")) << run.err;
  const std::string bytes = *recordings::read_file(folder / "out/DJ1/motion.npz");
  const std::string contacts = array_of(bytes, "contacts");
  const std::string times = array_of(bytes, "time_s");
  const std::size_t frames = times.size() / sizeof(double);
  ASSERT_GT(frames, 0U);
  ASSERT_EQ(contacts.size(), 4 * frames);
  double last_s = 0.0;
  double first_s = 0.0;
  for (std::size_t f = 0; f < frames; ++f) {
    double time_s = 0.0;
    std::memcpy(&time_s, times.data() + f * sizeof(double), sizeof(double));
    const bool bears = contacts.substr(4 * f, 4) != std::string(4, '\0');
    if (bears && time_s < 2.5) last_s = time_s;
    if (bears && time_s > 2.5 && first_s == 0.0) first_s = time_s;
  }
  EXPECT_NEAR(last_s, 2.260, 0.015);
  EXPECT_NEAR(first_s, 2.765, 0.015);
}

}  // namespace
}  // namespace marey::testing
