// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/stage/live/stage_vmc.h"

#include <chrono>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "live/vmc/vmc_receiver.h"
#include "tests/app/stage/live/live_scene.h"

namespace marey::app {
namespace {

using namespace std::chrono_literals;

std::string refusal_of(const std::vector<std::string>& vmc) {
  const auto routes = plan_vmc(live_scene().scene, vmc);
  EXPECT_FALSE(routes);
  return routes ? std::string() : routes.error().message();
}

TEST(StageVmc, PlansTheReceiversOfSceneAndOptions) {
  const Scene scene = live_scene().scene;
  const auto none = plan_vmc(scene, {});
  ASSERT_TRUE(none);
  ASSERT_EQ(none->size(), 1U);
  EXPECT_EQ((*none)[0].body, 1U);
  EXPECT_EQ(live::text_of((*none)[0].address), "127.0.0.1:39540");
  const auto more = plan_vmc(scene, {"10.0.0.2", "crowd.3=10.0.0.3:5000"});
  ASSERT_TRUE(more);
  ASSERT_EQ(more->size(), 3U);
  EXPECT_EQ((*more)[1].body, 1U);
  EXPECT_EQ(live::text_of((*more)[1].address), "10.0.0.2:39540");
  EXPECT_EQ((*more)[2].body, 2U);
  EXPECT_EQ(live::text_of((*more)[2].address), "10.0.0.3:5000");
}

TEST(StageVmc, SendsTheFirstBodyOfASceneWithoutReceivers) {
  Scene scene = live_scene().scene;
  scene.out.vmc.clear();
  const auto routes = plan_vmc(scene, {"10.0.0.2"});
  ASSERT_TRUE(routes);
  ASSERT_EQ(routes->size(), 1U);
  EXPECT_EQ((*routes)[0].body, 0U);
  EXPECT_EQ((*routes)[0].address.port, live::kMarionettePort);
}

TEST(StageVmc, RefusesByCause) {
  EXPECT_NE(refusal_of({"bob=10.0.0.2"}).find("no body"), std::string::npos);
  EXPECT_NE(refusal_of({"crowd=10.0.0.2"}).find("is a group"), std::string::npos);
  EXPECT_NE(refusal_of({"10.0.0.2:x"}).find("port"), std::string::npos);
}

TEST(StageVmc, SendsThePosturesOfABody) {
  auto run = SceneRun::make(live_scene());
  ASSERT_TRUE(run) << run.error().message();
  auto receiver = live::VmcReceiver::open({"127.0.0.1", 0});
  ASSERT_TRUE(receiver);
  auto vmc = StageVmc::open({{1, {"127.0.0.1", receiver->port()}}}, *run);
  ASSERT_TRUE(vmc) << vmc.error().message();
  live::VmcFrame frame;
  bool has_frame = false;
  for (int step = 0; step < 100 && !has_frame; ++step) {
    run->advance();
    vmc->send(step * 16ms, *run);
    receiver->wait(100ms);
    has_frame = receiver->receive(frame);
  }
  ASSERT_TRUE(has_frame);
  EXPECT_EQ(vmc->failed(), 0);
  const auto& character = run->body(1).character;
  auto converter = live::VmcBody::make(
      character.skeleton, {.t_pose_from_joint = character.t_pose_from_joint});
  ASSERT_TRUE(converter);
  Pose shown;
  shown.parent_from_joint.resize(character.skeleton.joints.size());
  converter->from_vmc(frame.pose, shown);
  // The body stands nearly still.
  EXPECT_LT(glm::distance(shown.root_in_world, run->pose(1).root_in_world), 0.02);
}

}  // namespace
}  // namespace marey::app
