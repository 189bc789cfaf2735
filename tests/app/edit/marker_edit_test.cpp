// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// `marey edit` on labelled markers: C3D and TRC.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/edit/edit_session.h"
#include "recordings/markers/c3d_analog.h"
#include "tests/app/edit/marker_edit_scene.h"

namespace marey::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kCut = "[[op]]\ndo = \"cut@1\"\nfrom_frame = 30\nto_frame = 129\n";
constexpr const char* kFilter = "[[op]]\ndo = \"filter@1\"\n";

/// Returns the largest distance of the same markers, with the frames of `b` from `first`
/// on. Infinite if other samples are seen.
double largest_distance_m(const MarkerTracks& a,
                          const MarkerTracks& b,
                          std::size_t first = 0) {
  double largest = 0.0;
  for (std::size_t t = 0; t < a.frames(); ++t) {
    for (std::size_t m = 0; m < a.markers(); ++m) {
      const auto& one = a.at(t, m);
      const auto& other = b.at(t + first, m);
      if (one.has_value() != other.has_value()) return HUGE_VAL;
      if (!one) continue;
      largest = std::max(largest, glm::distance(one->p_in_world, other->p_in_world));
    }
  }
  return largest;
}

TEST(MarkerEdit, GivesTheSourceWithoutOperations) {
  const MarkerEditFolder folder;
  folder.write_recipe("");
  const ProgramRun run = folder.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto source = folder.read("walk.c3d");
  const auto c3d = folder.read("out/a.c3d");
  EXPECT_EQ(c3d.tracks.labels, source.tracks.labels);
  EXPECT_EQ(c3d.tracks.first_frame, 21);
  EXPECT_EQ(largest_distance_m(c3d.tracks, source.tracks), 0.0);
  EXPECT_EQ(c3d.events, source.events);
  // These markers do not stand on the floor, so their file does not show that Y is up.
  recordings::MarkerReadOptions y_up;
  y_up.up = recordings::FileAxis::kPlusY;
  const auto read = recordings::read_markers(folder / "out/a.trc", y_up);
  ASSERT_TRUE(read) << read.error().message();
  const recordings::MarkerFile& trc = *read;
  EXPECT_LT(largest_distance_m(trc.tracks, source.tracks), 1e-12);
  EXPECT_EQ(trc.tracks.first_frame, 21);
  EXPECT_TRUE(fs::exists(folder / "out/a.annotations.json"));
  EXPECT_TRUE(fs::exists(folder / "out/a.edit.json"));
}

TEST(MarkerEdit, WritesTheSameBytesEachTime) {
  const MarkerEditFolder folder;
  folder.write_recipe(std::string(kCut) + kFilter);
  ASSERT_EQ(folder.run().exit_code, 0);
  const std::vector<std::string> names{
      "out/a.c3d", "out/a.trc", "out/a.annotations.json", "out/a.edit.json"};
  std::vector<std::string> before;
  for (const std::string& name : names) before.push_back(folder.bytes(name));
  fs::remove_all(folder / "out");
  ASSERT_EQ(folder.run().exit_code, 0);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(folder.bytes(names[i]), before[i]) << names[i];
    EXPECT_NE(before[i], "missing") << names[i];
  }
}

TEST(MarkerEdit, ACutC3dKeepsItsAnalogChannelsAndEvents) {
  const MarkerEditFolder folder;
  folder.write_recipe(kCut);
  const ProgramRun run = folder.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err.find("not in the results"), std::string::npos) << run.err;
  const auto source = folder.read("walk.c3d");
  const auto cut = folder.read("out/a.c3d");
  ASSERT_EQ(cut.tracks.frames(), 100U);
  EXPECT_EQ(cut.tracks.first_frame, 51);
  EXPECT_EQ(largest_distance_m(cut.tracks, source.tracks, 30), 0.0);
  const auto analog = recordings::read_analog(folder / "out/a.c3d");
  ASSERT_TRUE(analog) << analog.error().message();
  ASSERT_EQ(analog->signals.size(), 2U);
  ASSERT_EQ(analog->signals[0].samples.size(), 400U);
  EXPECT_DOUBLE_EQ(analog->start_s, 50.0 / 120.0);
  // Channel 1 in the first and the last frame.
  EXPECT_EQ(analog->signals[1].samples[0], 10.0 * 30 + 1);
  EXPECT_EQ(analog->signals[1].samples[396], 10.0 * 129 + 1);
  // From 0.417 to 1.242 s: the first two events.
  ASSERT_EQ(cut.events.size(), 2U);
  EXPECT_EQ(cut.events[0], source.events[0]);
  EXPECT_EQ(cut.events[1], source.events[1]);
}

TEST(MarkerEdit, EventsOfTheC3dAreInstants) {
  const MarkerEditFolder folder;
  folder.write_recipe(
      "[[op]]\ndo = \"event@1\"\ntext = \"clap\"\nat_s = 0.25\n"
      "[[op]]\ndo = \"cut@1\"\nfrom = \"left.strike\"\nto = \"left.strike[1]\"\n"
      "[[op]]\ndo = \"event@1\"\ntext = \"right.toe_off\"\nat_s = 0.75\n");
  const ProgramRun run = folder.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto cut = folder.read("out/a.c3d");
  EXPECT_EQ(cut.tracks.frames(), 121U);
  EXPECT_EQ(cut.tracks.first_frame, 61);
  ASSERT_EQ(cut.events.size(), 4U);
  EXPECT_EQ(cut.events[1].label, "Foot Off");
  EXPECT_EQ(cut.events[1].subject, "Ann");
  EXPECT_EQ(cut.events[3].label, "Foot Off");
  EXPECT_EQ(cut.events[3].context, "Right");
  EXPECT_NEAR(cut.events[3].time_s, 0.5 + 0.75, 1e-6);
  const Json notes = Json::parse(folder.bytes("out/a.annotations.json")).at("notes");
  ASSERT_EQ(notes.size(), 4U);
  EXPECT_EQ(notes[0].at("text"), "left.strike");
}

TEST(MarkerEdit, ReportsContentThatAResultLacks) {
  const MarkerEditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"place@1\"\nposition_xz_m = [0, 0]\n");
  const ProgramRun moved = folder.run();
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  EXPECT_NE(moved.err.find("2 analog channels, 1 point that is no marker and the "
                           "parameters are not in the results: an operation moved the "
                           "markers"),
            std::string::npos)
      << moved.err;
  const auto analog = recordings::read_analog(folder / "out/a.c3d");
  ASSERT_TRUE(analog);
  EXPECT_TRUE(analog->signals.empty());
  // Events are markers' own and are kept.
  EXPECT_EQ(folder.read("out/a.c3d").events.size(), 3U);
  folder.write_recipe("[[op]]\ndo = \"retime@1\"\nrate_hz = 100\n");
  const ProgramRun retimed = folder.run();
  EXPECT_NE(retimed.err.find("not consecutive frames of the source"), std::string::npos)
      << retimed.err;
  folder.write_recipe(kFilter);
  const ProgramRun table = folder.run({"--format", "trc"});
  EXPECT_NE(table.err.find("a TRC holds markers only"), std::string::npos) << table.err;
  EXPECT_NE(table.err.find("a TRC holds no events; 3 are not in it"), std::string::npos);
}

TEST(MarkerEdit, FiltersAndReportsItsFigures) {
  const MarkerEditFolder folder;
  folder.write_recipe(kFilter);
  const ProgramRun run = folder.run({"--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);
  const Json& figures = json.at("operations").at(0).at("figures");
  // The noise is 2 mm in each coordinate.
  EXPECT_NEAR(figures.at("LASI_noise_mm").get<double>(), 2.0, 0.4);
  EXPECT_GT(figures.at("LASI_cutoff_hz").get<double>(), 1.0);
  const Json& result = json.at("results").at(0);
  EXPECT_EQ(result.at("markers"), 4);
  EXPECT_EQ(result.at("frames"), 240);
  EXPECT_EQ(result.at("displaced_mm"), figures.at("displaced_mm"));
  EXPECT_LT(result.at("acceleration_ratio").get<double>(), 0.5);
  EXPECT_EQ(result.at("keeps_other_content"), true);
  const auto out = folder.read("out/a.c3d");
  for (std::size_t t = 100; t < 110; ++t) EXPECT_FALSE(out.tracks.at(t, 2));
}

TEST(MarkerEdit, ATrcKeepsItsNumbersToTheBit) {
  const MarkerEditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nto_frame = 59\n", "walk.trc");
  ASSERT_EQ(folder.run({"--format", "trc"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "out/a.c3d"));
  const auto out = folder.read("out/a.trc");
  ASSERT_EQ(out.tracks.frames(), 60U);
  EXPECT_EQ(largest_distance_m(out.tracks, folder.read("walk.trc").tracks), 0.0);
}

TEST(MarkerEdit, RefusesOperationsOfABodyWithFileAndLine) {
  const MarkerEditFolder folder;
  folder.write_recipe("[[op]]\ndo = \"plant@1\"\n");
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("a.edit.toml:5: plant@1: cannot be applied to labelled markers"),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find(" fit)"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out/a.c3d"));
  EXPECT_EQ(folder.run({"--until", "0"}).exit_code, 0);
}

TEST(MarkerEdit, RefusesBrokenFilesAndWrongFormats) {
  const MarkerEditFolder folder;
  ASSERT_TRUE(recordings::write_file(folder / "broken.c3d", "no markers"));
  folder.write_recipe("", "broken.c3d");
  const ProgramRun broken = folder.run();
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_NE(broken.err.find("a.edit.toml:3: "), std::string::npos) << broken.err;
  EXPECT_NE(broken.err.find("broken.c3d"), std::string::npos) << broken.err;
  folder.write_recipe("", "gone.c3d");
  EXPECT_EQ(folder.run().exit_code, 3);
  folder.write_recipe("");
  const ProgramRun npz = folder.run({"--format", "npz"});
  EXPECT_EQ(npz.exit_code, 2);
  EXPECT_NE(npz.err.find("choose c3d or trc"), std::string::npos) << npz.err;
  EXPECT_EQ(folder.run({"--format", "xyz"}).exit_code, 2);
}

TEST(MarkerEdit, HasOneSource) {
  const MarkerEditFolder folder;
  folder.write_recipe("");
  const std::string text =
      "format = 1\nname = \"b\"\n[[source]]\npath = \"walk.c3d\"\n"
      "[[source]]\nid = \"next\"\npath = \"walk.trc\"\n";
  ASSERT_TRUE(recordings::write_file(folder / "b.edit.toml", text));
  const ProgramRun run = folder.run({}, "b.edit.toml");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("has one source"), std::string::npos) << run.err;
}

TEST(MarkerEdit, PinsAndRefusesChangedSources) {
  const MarkerEditFolder folder;
  ASSERT_EQ(folder.call({"edit", "walk.c3d", "--new", "n.edit.toml"}).exit_code, 0);
  EXPECT_NE(folder.bytes("n.edit.toml").find("sha256"), std::string::npos);
  ASSERT_EQ(folder.run({}, "n.edit.toml").exit_code, 0);
  folder.write_recipe("");
  ASSERT_EQ(folder.run({"--pin"}).exit_code, 0);
  folder.write_c3d("walk.c3d", 2);
  const ProgramRun run = folder.run();
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("has another content"), std::string::npos) << run.err;
  EXPECT_EQ(folder.run({"--accept-new-source"}).exit_code, 0);
}

TEST(MarkerEdit, ChecksLimitsWithoutWriting) {
  const MarkerEditFolder folder;
  folder.write_recipe(std::string(kFilter) + "[limits]\ndisplaced_mm = 0.5\n");
  const ProgramRun run = folder.run({"--check"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find("displacement of a joint or marker"), std::string::npos)
      << run.err;
  EXPECT_FALSE(fs::exists(folder / "out/a.c3d"));
  folder.write_recipe("[limits]\nslide_mm = 1\n");
  const ProgramRun slide = folder.run();
  EXPECT_EQ(slide.exit_code, 3);
  EXPECT_NE(slide.err.find("slide_mm cannot be measured on labelled markers"),
            std::string::npos)
      << slide.err;
}

TEST(MarkerEdit, EditsManyFilesAndGoesOnAfterAFailure) {
  const MarkerEditFolder folder;
  fs::create_directory(folder / "takes");
  folder.write_c3d("takes/one.c3d", 3);
  folder.write_c3d("takes/two.c3d", 4);
  ASSERT_TRUE(recordings::write_file(folder / "takes/bad.c3d", "no markers"));
  folder.write_recipe(kFilter);
  const ProgramRun run = folder.run({"--each", "takes/*.c3d"});
  EXPECT_EQ(run.exit_code, 4) << run.err;
  for (const char* name : {"one", "two"}) {
    for (const char* ending : {".c3d", ".trc", ".edit.json"}) {
      EXPECT_TRUE(fs::exists(folder / ("out/" + std::string(name) + ending))) << name;
    }
  }
  const std::string table = folder.bytes("out/edit.csv");
  EXPECT_NE(table.find("\"one\",\"takes/one.c3d\",240,1.99167,,,"), std::string::npos)
      << table;
  EXPECT_NE(table.find("\"bad\",\"takes/bad.c3d\",,,,,,,,,\""), std::string::npos)
      << table;
}

TEST(MarkerEdit, DiffNamesTheMarkerAndTheOperations) {
  const MarkerEditFolder folder;
  folder.write_recipe(kFilter);
  folder.write_recipe("", "walk.c3d", "b");
  const ProgramRun run = folder.call({"edit", "diff", "a.edit.toml", "b.edit.toml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("- [[op]]  do = \"filter@1\""), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("frames: 240 and 240"), std::string::npos) << run.out;
  const ProgramRun json =
      folder.call({"edit", "diff", "a.edit.toml", "b.edit.toml", "--json"});
  const Json difference = Json::parse(json.out);
  ASSERT_EQ(folder.run().exit_code, 0);
  const auto out = folder.read("out/a.c3d");
  EXPECT_NEAR(difference.at("largest_mm").get<double>(),
              1e3 * largest_distance_m(out.tracks, folder.read("walk.c3d").tracks),
              1e-3);
  const std::string marker = difference.at("marker");
  EXPECT_EQ(marker.size(), 4U);
}

TEST(MarkerEdit, ARecipeCanBeTheSourceOfAnother) {
  const MarkerEditFolder folder;
  folder.write_recipe(std::string(kCut) + kFilter);
  folder.write_recipe("[[op]]\ndo = \"cut@1\"\nto_frame = 49\n", "a.edit.toml", "b");
  ASSERT_EQ(folder.run().exit_code, 0);
  const ProgramRun run = folder.run({}, "b.edit.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("the source is another recipe"), std::string::npos) << run.err;
  const auto inner = folder.read("out/a.trc");
  const auto outer = folder.read("out/b.trc");
  EXPECT_EQ(outer.tracks.frames(), 50U);
  EXPECT_EQ(largest_distance_m(outer.tracks, inner.tracks), 0.0);
}

/// Ignores everything.
class SilentListener : public app::EditListener {
 public:
  void on_revision(const app::EditSession& /*session*/) override {}
  void on_progress(const app::EditProgress& /*progress*/) override {}
  void on_rendered(const app::EditResult& /*result*/) override {}
  void on_preview(const app::EditAsker& /*asker*/,
                  const app::PreviewParts& /*parts*/,
                  const app::EditResult& /*result*/) override {}
  void on_loops(const app::EditAsker& /*asker*/,
                const app::EditLoops& /*loops*/) override {}
  void on_jump(const app::EditAsker& /*asker*/, const app::EditJump& /*jump*/) override {}
  void on_exported(const app::EditAsker& /*asker*/,
                   const app::EditExported& /*exported*/) override {}
  void on_failed(const app::EditAsker& /*asker*/, const Error& /*error*/) override {}
};

TEST(MarkerEdit, IsRefusedByThePage) {
  const MarkerEditFolder folder;
  folder.write_recipe("");
  app::EditSessionOptions options;
  options.recipe_file = folder / "a.edit.toml";
  SilentListener listener;
  const auto session = app::EditSession::open(options, listener);
  ASSERT_FALSE(session);
  EXPECT_NE(session.error().message().find("cannot be edited on the page"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "a.edit.journal"));
}

/// A recording of a lab, with gaps, force plates and analog channels.
TEST(MarkerEdit, KeepsGapsAndAnalogChannelsOfARealFile) {
  const fs::path source = shared_data() / "mocap/opensim-core/Tests/shared/walking2.c3d";
  if (!fs::exists(source)) GTEST_SKIP() << source << " is absent";
  const MarkerEditFolder folder;
  folder.write_recipe(
      "[[op]]\ndo = \"cut@1\"\nfrom_s = 0.2\nto_s = 1.0\n" + std::string(kFilter),
      source.string());
  const ProgramRun run = folder.run();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto before = folder.read(source.string());
  const auto after = folder.read("out/a.c3d");
  const std::size_t first = 50;
  ASSERT_EQ(after.tracks.frames(), 201U);
  std::size_t seen = 0;
  for (std::size_t t = 0; t < after.tracks.frames(); ++t) {
    for (std::size_t m = 0; m < after.tracks.markers(); ++m) {
      const auto& old = before.tracks.at(t + first, m);
      const auto& now = after.tracks.at(t, m);
      ASSERT_EQ(old.has_value(), now.has_value());
      if (!now) continue;
      ++seen;
      EXPECT_LT(glm::distance(old->p_in_world, now->p_in_world), 0.005);
    }
  }
  EXPECT_GT(seen, 100U);
  const auto analog_before = recordings::read_analog(source);
  const auto analog_after = recordings::read_analog(folder / "out/a.c3d");
  ASSERT_TRUE(analog_before && analog_after);
  ASSERT_EQ(analog_after->signals.size(), analog_before->signals.size());
  const auto per_frame = static_cast<std::size_t>(
      std::lround(analog_before->rate.hz / before.tracks.rate.hz));
  for (std::size_t i = 0; i < analog_after->signals.size(); ++i) {
    ASSERT_EQ(analog_after->signals[i].samples.size(), 201 * per_frame);
    EXPECT_EQ(analog_after->signals[i].samples.front(),
              analog_before->signals[i].samples[first * per_frame]);
  }
}

}  // namespace
}  // namespace marey::testing
