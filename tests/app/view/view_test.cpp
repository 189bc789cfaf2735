// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that `marey view` serves. Tests in live/viewer check that pages show them.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/view/view_files.h"
#include "app/view/view_page.h"
#include "app/view/view_trial.h"
#include "app/view/view_trials.h"
#include "core/human/average_proportions.h"
#include "live/page/page_scene.h"
#include "live/web/web_server.h"
#include "recordings/markers/marker_file.h"
#include "recordings/motion/bvh.h"
#include "recordings/motion/motion_tables.h"
#include "recordings/session/calibration_file.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/run_program.h"
#include "tests/support/program/scratch_folder.h"
#include "tests/support/program/web_socket.h"
#include "tests/support/simulation/synthetic_rig.h"

namespace marey::app {
namespace {

namespace fs = std::filesystem;
using namespace marey::testing;

constexpr int kViewFrames = 30;

/// A synthetic walk as `marey process` would leave it, in OUT/walk.
class View : public ::testing::Test {
 protected:
  void SetUp() override {
    const Skeleton skeleton = make_humanoid(average_proportions(1.75));
    walk_.motion = walking(skeleton, kViewFrames);
    walk_.motion.first_frame = 7;
    walk_.uncertainty.assign(kViewFrames,
                             std::vector<JointUncertainty>(skeleton.joints.size()));
    for (std::size_t i = 0; i < kViewFrames; ++i) {
      walk_.uncertainty[i][0] = {0.001, i < 10 ? Source::kMeasured : Source::kRepaired};
    }
    fs::create_directories(out() / "walk");
    ASSERT_TRUE(recordings::write_bvh(out() / "walk/motion.bvh", walk_.motion));
    ASSERT_TRUE(recordings::write_segments_csv(out() / "walk/segments.csv", walk_));
    ASSERT_TRUE(recordings::write_joints_csv(out() / "walk/joints.csv", walk_));
  }

  [[nodiscard]] fs::path out() const { return folder_ / "out"; }
  [[nodiscard]] fs::path in_folder(const char* name) const { return folder_ / name; }

  static Motion walking(const Skeleton& skeleton, int frames) {
    Motion motion{skeleton, {30.0}, 0, {}};
    for (int i = 0; i < frames; ++i) {
      Pose pose = rest_pose(skeleton);
      pose.root_in_world.z = 0.03 * i;
      motion.poses.push_back(pose);
    }
    return motion;
  }

  EstimatedMotion walk_;

 private:
  ScratchFolder folder_;
};

TEST_F(View, ShowsTheSolutionWithItsUncertainty) {
  std::ofstream(out() / "report.json")
      << R"({"trials":[{"name":"walk","frame_rms_px":[0.5,0.25]}]})";
  const auto view = read_view({.what = out(), .trial = {}, .avatars = {}});
  ASSERT_TRUE(view) << view.error().message();
  EXPECT_EQ(view->title, "walk");
  EXPECT_EQ(view->first_frame, 7);
  EXPECT_EQ(view->frames, kViewFrames);
  ASSERT_EQ(view->figures.size(), 1U);
  EXPECT_EQ(view->figures[0].uncertainty[9][0].source, Source::kMeasured);
  EXPECT_EQ(view->figures[0].uncertainty[9][0].sigma_m, 0.001);
  EXPECT_EQ(view->figures[0].uncertainty[10][0].source, Source::kRepaired);
  // The hips alone were ever seen.
  ASSERT_EQ(view->tracks.size(), 1U);
  EXPECT_EQ(view->tracks[0].name, "hips");
  ASSERT_EQ(view->tracks[0].gaps.size(), 1U);
  EXPECT_EQ(view->tracks[0].gaps[0].span.first, 17);
  EXPECT_EQ(view->tracks[0].gaps[0].span.last, 36);
  ASSERT_EQ(view->graphs.size(), 2U);
  EXPECT_EQ(view->graphs[0].name, "reprojection");
  EXPECT_EQ(view->graphs[0].values.size(), static_cast<std::size_t>(kViewFrames));
  EXPECT_EQ(view->graphs[0].values[1], 0.25);
}

// The motion's file counts from 0, segments.csv and the page from 7.
TEST_F(View, DragsInTheFrameThatThePageShows) {
  const auto view = read_view({.what = out() / "walk", .trial = {}, .avatars = {}});
  ASSERT_TRUE(view) << view.error().message();
  auto handles = ViewHandles::make(*view, {});
  ASSERT_TRUE(handles);
  constexpr live::ClientId kViewPage{1};
  const live::DragRequest last{
      "head", {0.0, 1.6, 0.9}, live::DragPhase::kMove, 7 + kViewFrames - 1};
  ASSERT_TRUE(handles->drag(kViewPage, last));
  const auto adapted = handles->adapted(kViewPage);
  ASSERT_TRUE(adapted && *adapted);
  EXPECT_EQ((*adapted)->frame, kViewFrames - 1);
}

TEST_F(View, GivesNegativeTimesBeforeTheFirstFrame) {
  auto view = read_view({.what = out() / "walk", .trial = {}, .avatars = {}});
  ASSERT_TRUE(view) << view.error().message();
  view->first_frame = -3;
  const std::string frame = frame_with(*view, 0, 0, view->figures[0].motion.poses[0]);
  double time_s = 0.0;
  std::memcpy(&time_s, frame.data() + 8, sizeof time_s);
  EXPECT_EQ(time_s, -0.1);
}

TEST_F(View, EncodesEveryFrameOfEveryFigure) {
  const auto view = read_view({.what = out() / "walk", .trial = {}, .avatars = {}});
  ASSERT_TRUE(view) << view.error().message();
  const auto page = page_of_recording(*view);
  ASSERT_TRUE(page);
  ASSERT_EQ(page->media.size(), 1U);
  EXPECT_EQ(page->media[0].path, page->scene.file->block);
  const std::string& block = *page->media[0].bytes;
  constexpr std::size_t kJoints = 22;
  // Sources of 22 joints take 24 bytes; feet that slide like this bear nothing. The zero
  // moment point takes 8.
  constexpr std::size_t kFrameBytes =
      24 + 4 + 12 + 16 * kJoints + 4 * kJoints + 24 + 16 + 8;
  ASSERT_EQ(block.size(), 16 + kViewFrames * kFrameBytes);
  std::uint32_t frame = 0;
  std::memcpy(&frame, block.data() + 16 + 29 * kFrameBytes + 4, sizeof frame);
  EXPECT_EQ(frame, 36U);
  float z = 0.0F;
  std::memcpy(&z, block.data() + 16 + 29 * kFrameBytes + 28 + 8, sizeof z);
  EXPECT_NEAR(z, 0.87, 1e-5);  // BVH has six decimals of a centimetre.
}

TEST_F(View, PlacesAvatarsNextToTheSource) {
  const auto view =
      read_view({.what = out(), .trial = "walk", .avatars = {out() / "walk/motion.bvh"}});
  ASSERT_TRUE(view) << view.error().message();
  const auto page = page_of_recording(*view);
  ASSERT_TRUE(page);
  ASSERT_EQ(page->scene.skeletons.size(), 2U);
  EXPECT_EQ(page->scene.skeletons[0].kind, live::PageSkeletonKind::kPerformer);
  EXPECT_EQ(page->scene.skeletons[1].kind, live::PageSkeletonKind::kAvatar);
  EXPECT_GT(page->scene.skeletons[1].offset_m.x, 0.8);
}

TEST_F(View, ShowsMarkersAndCamerasAlone) {
  recordings::MarkerFile markers;
  markers.tracks.labels = {"LASI", "RASI"};
  markers.tracks.rate = {100.0};
  for (int i = 0; i < 6; ++i) {
    markers.tracks.samples.emplace_back(MarkerSample{.p_in_world = {0.1 * i, 1.0, 0.2}});
  }
  markers.tracks.samples[3].reset();
  ASSERT_TRUE(recordings::write_markers(in_folder("a.trc"), markers));
  const auto view = read_view({.what = in_folder("a.trc"), .trial = {}, .avatars = {}});
  ASSERT_TRUE(view) << view.error().message();
  EXPECT_EQ(view->frames, 3);
  ASSERT_TRUE(view->points);
  ASSERT_EQ(view->tracks.size(), 2U);
  EXPECT_EQ(view->tracks[1].gaps[0].span.first, 2);

  recordings::Calibration calibration;
  calibration.cameras = {ring_of_cameras().front()};
  calibration.quality.resize(1);
  calibration.clocks.resize(1);
  const fs::path file = in_folder("calibration.toml");
  ASSERT_TRUE(recordings::write_calibration(file, calibration));
  const auto cameras = read_view({.what = file, .trial = {}, .avatars = {}});
  ASSERT_TRUE(cameras) << cameras.error().message();
  EXPECT_EQ(cameras->cameras.size(), 1U);
  EXPECT_FALSE(cameras->cameras[0].rms_px);
}

TEST_F(View, TurnsToOtherTrialsAndServesTheReport) {
  fs::copy(out() / "walk", out() / "jump", fs::copy_options::recursive);
  fs::create_directories(out() / "calib");  // No trial that was solved.
  std::ofstream(out() / "report.html") << "<p>report";
  auto trials = ViewTrials::open({.what = out(), .trial = "walk", .avatars = {}}, {});
  ASSERT_TRUE(trials) << trials.error().message();
  live::WebServerOptions options;
  options.port = 0;
  auto server = live::WebServer::start(options);
  ASSERT_TRUE(server);
  trials->serve(*server);
  const std::string& scene = trials->first().scene;
  EXPECT_NE(scene.find(R"("trial":"walk","trials":["jump","walk"])"), std::string::npos);
  EXPECT_NE(scene.find(R"("report":"/report.html")"), std::string::npos);

  const live::ClientId one{1};
  EXPECT_EQ(trials->seen_by(one).name, "walk");
  const auto jump = trials->show(one, "jump", *server);
  ASSERT_TRUE(jump) << jump.error().message();
  EXPECT_NE(jump->find(R"("trial":"jump")"), std::string_view::npos);
  EXPECT_NE(jump->find("/media/2"), std::string_view::npos)
      << "its own, next to the first's";
  EXPECT_EQ(trials->seen_by(one).name, "jump");
  EXPECT_EQ(trials->seen_by(live::ClientId{2}).name, "walk") << "another page stays";
  for (const char* name : {"calib", "..", "walk/../jump", ""}) {
    EXPECT_FALSE(trials->show(one, name, *server)) << name;
  }
  EXPECT_EQ(trials->seen_by(one).name, "jump");

  const std::string report = fetch(server->port(), "/report.html");
  EXPECT_EQ(status(report), 200);
  EXPECT_EQ(body(report), "<p>report");
  EXPECT_TRUE(
      header(report, "Content-Security-Policy").starts_with("default-src 'none'"));
  EXPECT_EQ(status(fetch(server->port(), "/media/1")), 200);
  EXPECT_EQ(status(fetch(server->port(), "/media/2")), 200);
  for (const char* path :
       {"/report.json", "/calibration.html", "/walk/motion.bvh", "/media/3"}) {
    EXPECT_EQ(status(fetch(server->port(), path)), 404) << path;
  }
}

// The other trials are in the parent folder of the opened trial's folder.
TEST_F(View, TurnsToOtherTrialsFromOne) {
  fs::copy(out() / "walk", out() / "jump", fs::copy_options::recursive);
  auto trials =
      ViewTrials::open({.what = out() / "jump", .trial = {}, .avatars = {}}, {});
  ASSERT_TRUE(trials) << trials.error().message();
  EXPECT_EQ(trials->first().name, "jump");
  EXPECT_EQ(trials->first().scene.find("/report.html"), std::string::npos);
  live::WebServerOptions options;
  options.port = 0;
  auto server = live::WebServer::start(options);
  ASSERT_TRUE(server);
  EXPECT_TRUE(trials->show(live::ClientId{1}, "walk", *server));
}

TEST_F(View, ReportsInputsThatCannotBeShown) {
  const auto cause = [](const ViewChoice& choice) {
    const auto view = read_view(choice);
    return view ? std::string("shown") : view.error().cause;
  };
  EXPECT_EQ(cause({.what = in_folder("gone"), .trial = {}, .avatars = {}}),
            "the file does not exist");
  EXPECT_EQ(cause({.what = out(), .trial = "run", .avatars = {}}),
            "has no trial \"run\"");
  fs::create_directories(in_folder("empty"));
  EXPECT_EQ(cause({.what = in_folder("empty"), .trial = {}, .avatars = {}}),
            "holds no results: no trial in it has a segments.csv");
  std::ofstream(in_folder("a.txt")) << "text";
  EXPECT_EQ(cause({.what = in_folder("a.txt"), .trial = {}, .avatars = {}}),
            "is not a kind of file that can be shown");
}

// Results can come from another person. A link in them can point to a private file of the
// user, which the program must not serve.
TEST_F(View, DoesNotFollowLinksOutOfTheFolder) {
  const fs::path secret = in_folder("secret.html");
  std::ofstream(secret) << "secret";
  fs::create_symlink(secret, out() / "report.html");
  const ViewChoice choice{.what = out(), .trial = {}, .avatars = {}};
  auto page = ViewTrials::open(choice, {});
  ASSERT_TRUE(page) << page.error().message();
  EXPECT_EQ(page->first().scene.find("report.html"), std::string::npos);
  fs::create_directories(in_folder("other"));
  fs::create_directory_symlink(out() / "walk", in_folder("other/walk"));
  EXPECT_TRUE(solved_trials(in_folder("other")).empty());
  fs::rename(out() / "walk/motion.bvh", in_folder("motion.bvh"));
  fs::create_symlink(in_folder("motion.bvh"), out() / "walk/motion.bvh");
  const auto view = read_view(choice);
  ASSERT_FALSE(view);
  EXPECT_NE(view.error().where.find("motion.bvh"), std::string::npos);
  EXPECT_NE(view.error().cause.find("leads out of the folder"), std::string::npos);
}

// Links that stay in the folder are the user's affair.
TEST_F(View, FollowsLinksInsideTheFolder) {
  fs::create_directories(out() / "shared");
  fs::rename(out() / "walk/motion.bvh", out() / "shared/motion.bvh");
  fs::create_symlink("../shared/motion.bvh", out() / "walk/motion.bvh");
  EXPECT_TRUE(read_view({.what = out(), .trial = {}, .avatars = {}}));
}

TEST_F(View, ServesUntilItsTimeIsOver) {
  const std::string what = (out() / "walk/motion.bvh").string();
  const ProgramRun run =
      run_program(marey::testing::program(),
                  {"view", what, "--port", "0", "--no-open", "--seconds", "0.05"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(run.out.starts_with("http://127.0.0.1:")) << run.out;
  const ProgramRun stopped = run_program(marey::testing::program(),
                                         {"view", what, "--port", "0", "--no-open"},
                                         {.folder = {}, .interrupt_at = "Ctrl-C"});
  EXPECT_EQ(stopped.exit_code, 0) << stopped.err;
  const ProgramRun lan = run_program(
      marey::testing::program(),
      {"view", what, "--port", "0", "--lan", "--no-open", "--seconds", "0.05"});
  EXPECT_EQ(lan.exit_code, 0) << lan.err;
  EXPECT_NE(lan.out.find("/?token="), std::string::npos) << lan.out;
  EXPECT_EQ(
      run_program(marey::testing::program(), {"view", what, "--port", "70000"}).exit_code,
      2);
}

}  // namespace
}  // namespace marey::app
