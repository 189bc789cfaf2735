// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/gltf/gltf.h"

#include <array>
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

#include "recordings/base/atomic_file.h"
#include "recordings/body/mannequin.h"
#include "tests/recordings/wild_motion.h"
#include "tests/support/program/paths.h"
#include "tests/support/program/scratch_folder.h"

namespace marey::recordings {
namespace {

using testing::ScratchFolder;

// Floats hold 2 m to 0.0001 mm, and a chain of ten quaternions multiplies that.
constexpr double kFloat_m = 5e-6;

std::filesystem::path avatar(const std::string& name) {
  return marey::testing::shared_data() / "avatars" / name;
}

struct Sample {
  Proportions proportions = uneven(mannequin_proportions({}));
  Skeleton skeleton = make_humanoid(proportions);
  SkinnedMesh mesh = make_mannequin_mesh(proportions);
  Motion motion = wild_motion(skeleton, 20);
};

Character written_and_read(const ScratchFolder& folder,
                           const Skeleton& skeleton,
                           const SkinnedMesh& mesh,
                           const Motion* motion) {
  const Status written = write_character(folder / "body.glb", skeleton, mesh, motion);
  EXPECT_TRUE(written) << written.error().message();
  auto read = read_character(folder / "body.glb");
  EXPECT_TRUE(read) << read.error().message();
  return read ? *std::move(read) : Character{};
}

glm::dvec3 rest_place(const Character& character, HumanBone bone) {
  const auto joint = character.skeleton.find(bone);
  EXPECT_TRUE(joint) << name(bone);
  const auto world = world_from_joints(character.skeleton, rest_pose(character.skeleton));
  return joint ? world[index(*joint)].translation : glm::dvec3(0.0);
}

double height_m(const SkinnedMesh& mesh) {
  const auto y = [](const glm::dvec3& v) { return v.y; };
  return std::ranges::max(mesh.p_in_world, {}, y).y -
         std::ranges::min(mesh.p_in_world, {}, y).y;
}

std::size_t corner_count(const SkinnedMesh& mesh) {
  std::size_t count = 0;
  for (const MeshPart& part : mesh.parts) count += part.triangles.size();
  return count;
}

TEST(Character, KeepsItsMotionThroughAFile) {
  const ScratchFolder folder;
  const Sample sample;
  const Character read =
      written_and_read(folder, sample.skeleton, sample.mesh, &sample.motion);
  ASSERT_TRUE(read.motion);
  EXPECT_LT(largest_distance_m(sample.motion, *read.motion), kFloat_m);
  EXPECT_LT(read.ignored_translation_m, 1e-9);
}

TEST(Character, KeepsTheMotionOfASkeletonThatRestsTurned) {
  const ScratchFolder folder;
  const Sample sample;
  const Skeleton turned = with_turned_axes(sample.skeleton);
  const Motion motion = wild_motion(turned, 20);
  const Character read = written_and_read(folder, turned, sample.mesh, &motion);
  ASSERT_TRUE(read.motion);
  EXPECT_LT(largest_distance_m(motion, *read.motion), kFloat_m);
}

TEST(Character, KeepsItsBonesThroughAFile) {
  const ScratchFolder folder;
  const Sample sample;
  const Character read = written_and_read(folder, sample.skeleton, sample.mesh, nullptr);
  ASSERT_EQ(read.skeleton.joints.size(), sample.skeleton.joints.size());
  for (std::size_t i = 0; i < sample.skeleton.joints.size(); ++i) {
    EXPECT_EQ(read.skeleton.joints[i].name, sample.skeleton.joints[i].name);
  }
  const Proportions p = proportions_of(read.skeleton);
  for (const HumanBone bone : human_bones()) {
    EXPECT_LT(glm::distance(p[bone], sample.proportions[bone]), 1e-12) << name(bone);
  }
  EXPECT_FALSE(read.motion);
}

TEST(Character, KeepsItsMeshThroughAFile) {
  const ScratchFolder folder;
  const Sample sample;
  const Character read = written_and_read(folder, sample.skeleton, sample.mesh, nullptr);
  ASSERT_TRUE(read.mesh);
  ASSERT_EQ(corner_count(*read.mesh), corner_count(sample.mesh));
  // Parts have their own vertices after reading: compare the posed corners.
  const Pose& pose = sample.motion.poses[7];
  const auto before = posed_vertices(sample.mesh, sample.skeleton, pose);
  const auto after = posed_vertices(*read.mesh, read.skeleton, pose);
  double largest_m = 0.0;
  for (std::size_t part = 0; part < sample.mesh.parts.size(); ++part) {
    const auto& a = sample.mesh.parts[part].triangles;
    const auto& b = read.mesh->parts[part].triangles;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest_m = std::max(largest_m, glm::distance(before[a[i]], after[b[i]]));
    }
  }
  EXPECT_LT(largest_m, kFloat_m);
}

TEST(Character, KeepsTheRate) {
  const ScratchFolder folder;
  const Sample sample;
  for (const double hz : {24.0, 29.97, 30.0, 60.0, 120.0}) {
    Motion motion = sample.motion;
    motion.rate.hz = hz;
    const Character read =
        written_and_read(folder, sample.skeleton, sample.mesh, &motion);
    ASSERT_TRUE(read.motion);
    EXPECT_NEAR(read.motion->rate.hz, hz, 1e-4 * hz);
    EXPECT_EQ(read.motion->poses.size(), motion.poses.size());
  }
}

TEST(Character, IsTheSameBytesAgain) {
  const ScratchFolder folder;
  const Sample sample;
  for (const char* file : {"a.glb", "b.glb"}) {
    ASSERT_TRUE(
        write_character(folder / file, sample.skeleton, sample.mesh, &sample.motion));
  }
  EXPECT_EQ(*read_file(folder / "a.glb"), *read_file(folder / "b.glb"));
}

TEST(ReadCharacter, ReadsRealAvatars) {
  struct Expected {
    const char* file;
    std::size_t joints;
    double height_m;
  };
  // Heights as in the avatars' PROVENANCE.md, CesiumMan's as in its POSITION bounds.
  const std::vector<Expected> avatars{
      {"makehuman/adult_male_mixamo_unity.glb", 64, 1.75},
      {"makehuman/adult_female_game_engine.glb", 53, 1.61},
      {"makehuman/giant_cmu_mb.glb", 31, 2.54},
      {"kaykit/manny_med_mod.gltf", 21, 2.21},
      {"khronos/cesium_man.gltf", 19, 1.507},
      {"vrm/cryptovoxels.vrm", 57, 1.49}};
  for (const Expected& expected : avatars) {
    if (!exists(avatar(expected.file))) GTEST_SKIP() << expected.file << " is missing";
    const auto read = read_character(avatar(expected.file));
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->skeleton.joints.size(), expected.joints) << expected.file;
    ASSERT_TRUE(read->mesh) << expected.file;
    EXPECT_NEAR(height_m(*read->mesh), expected.height_m, 0.02) << expected.file;
  }
}

TEST(ReadCharacter, TurnsAnOldVrmToFaceForward) {
  if (!exists(avatar("vrm/cryptovoxels.vrm"))) GTEST_SKIP() << "no avatars here";
  const auto read = read_character(avatar("vrm/cryptovoxels.vrm"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_GT(rest_place(*read, HumanBone::kLeftHand).x, 0.3);
  EXPECT_LT(rest_place(*read, HumanBone::kRightHand).x, -0.3);
}

TEST(ReadCharacter, ReadsTheHumanoidAndMotionOfAVrma) {
  if (!exists(avatar("threevrm/test.vrma"))) GTEST_SKIP() << "no avatars here";
  const auto read = read_character(avatar("threevrm/test.vrma"));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_TRUE(read->skeleton.find(HumanBone::kLeftUpperArm));
  EXPECT_NEAR(rest_place(*read, HumanBone::kHips).y, 0.85, 1e-6);
  EXPECT_GT(rest_place(*read, HumanBone::kHead).y, 1.3);
  EXPECT_FALSE(read->mesh);
  EXPECT_TRUE(read->motion);
}

TEST(ReadCharacter, ReadsAnAnimationWithoutAMesh) {
  if (!exists(avatar("kaykit/Med_MovementBasic.glb"))) GTEST_SKIP() << "no avatars here";
  const auto read = read_character(avatar("kaykit/Med_MovementBasic.glb"));
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_TRUE(read->motion);
  EXPECT_GT(read->motion->poses.size(), 10U);
  EXPECT_LT(read->ignored_translation_m, 1e-3);
}

TEST(WriteRetargeted, MovesRealAvatarsAndKeepsTheirMesh) {
  const ScratchFolder folder;
  for (const char* file : {"makehuman/adult_male_mixamo_unity.glb",
                           "kaykit/manny_med_mod.gltf",
                           "khronos/cesium_man.gltf",
                           "vrm/cryptovoxels.vrm"}) {
    if (!exists(avatar(file))) GTEST_SKIP() << file << " is missing";
    const auto before = read_character(avatar(file));
    ASSERT_TRUE(before) << before.error().message();
    Motion motion = wild_motion(before->skeleton, 20);
    const Status written = write_retargeted(avatar(file), folder / "out.glb", motion);
    ASSERT_TRUE(written) << written.error().message();
    const auto after = read_character(folder / "out.glb");
    ASSERT_TRUE(after) << after.error().message();
    ASSERT_TRUE(after->motion) << file;
    // Nodes without names would be confused with each other.
    Motion read = *after->motion;
    for (Motion* m : {&motion, &read}) {
      int number = 0;
      for (Joint& joint : m->skeleton.joints) joint.name = std::to_string(number++);
    }
    EXPECT_LT(largest_distance_m(motion, read), 1e-5) << file;
    EXPECT_EQ(before->mesh->p_in_world, after->mesh->p_in_world) << file;
  }
}

TEST(WriteRetargeted, EmbedsTheImagesNextToATextFile) {
  const ScratchFolder folder;
  const auto source = avatar("kaykit/manny_med_mod.gltf");
  if (!exists(source)) GTEST_SKIP() << "no avatars here";
  const auto character = read_character(source);
  ASSERT_TRUE(character) << character.error().message();
  ASSERT_TRUE(
      write_retargeted(source, folder / "out.glb", wild_motion(character->skeleton, 2)));
  const auto image = read_file(avatar("kaykit/mannequin_texture.png"));
  ASSERT_TRUE(image);
  EXPECT_NE(read_file(folder / "out.glb")->find(*image), std::string::npos);
}

TEST(WriteRetargeted, RefusesTheMotionOfAnotherBody) {
  const ScratchFolder folder;
  const Sample sample;
  ASSERT_TRUE(write_character(folder / "body.glb", sample.skeleton, sample.mesh));
  Motion other = sample.motion;
  other.skeleton.joints[3].name = "tail";
  const Status written = write_retargeted(folder / "body.glb", folder / "o.glb", other);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message().find("the motion's 'tail'"), std::string::npos);
  EXPECT_FALSE(exists(folder / "o.glb"));
}

/// Returns the error message of reading these bytes, from the cause on.
std::string refusal(const ScratchFolder& folder, std::string_view bytes) {
  EXPECT_TRUE(write_file(folder / "broken.glb", bytes));
  const auto read = read_character(folder / "broken.glb");
  if (read) return "no refusal";
  EXPECT_NE(read.error().where.find("broken.glb"), std::string::npos);
  return read.error().cause;
}

TEST(ReadCharacter, ReportsATruncatedFile) {
  const ScratchFolder folder;
  const Sample sample;
  ASSERT_TRUE(write_character(folder / "body.glb", sample.skeleton, sample.mesh));
  const std::string whole = *read_file(folder / "body.glb");
  EXPECT_EQ(refusal(folder, whole.substr(0, 5000)),
            "the file is cut short: it holds 5000 of " + std::to_string(whole.size()) +
                " bytes");
  EXPECT_EQ(refusal(folder, whole.substr(0, 15)), "the file ends in its header");
}

TEST(ReadCharacter, ReportsAFileThatIsNotGltf) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder, "not a body"), "this is neither a GLB file nor glTF text");
  EXPECT_EQ(refusal(folder, "HIERARCHY\nROOT hips\n"),
            "this is a BVH motion, not a glTF or VRM file");
  EXPECT_EQ(refusal(folder, "\x89PNG\r\n\x1a\n"),
            "this is a picture, not a glTF or VRM file");
  EXPECT_EQ(refusal(folder, ""), "the file is empty");
}

TEST(ReadCharacter, RefusesAnAccessorThatLeavesItsBuffer) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder,
                    R"({"asset":{"version":"2.0"},"nodes":[{"name":"hips"}],
 "buffers":[{"byteLength":4,"uri":"data:application/octet-stream;base64,AAAAAA=="}],
 "bufferViews":[{"buffer":0,"byteLength":4}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR"}],
 "animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}],
 "samplers":[{"input":0,"output":0}]}]})"),
            "accessor 0 reaches beyond the end of its buffer");
}

TEST(ReadCharacter, RefusesNodesBeyondAllReason) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder,
                    R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"hips","translation":[0,1e200,0]}]})"),
            "the node 'hips' lies further than 10 km away");
  EXPECT_EQ(refusal(folder,
                    R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"hips","scale":[1e200,1,1],"children":[1]},
          {"name":"spine","translation":[1,0,0]}]})"),
            "the node 'spine' lies further than 10 km away");
}

/// Returns a body of `joints` whose root rotates from the first key to one `last_s`
/// later.
std::string two_keys(const ScratchFolder& folder, int joints, float last_s) {
  const std::array<float, 10> keys{0, last_s, 0, 0, 0, 1, 0, 1, 0, 0};
  std::string bytes(sizeof keys, '\0');
  std::memcpy(bytes.data(), keys.data(), sizeof keys);
  EXPECT_TRUE(write_file(folder / "keys.bin", bytes));
  std::string nodes = R"({"name":"j0"})";
  std::string children;
  for (int i = 1; i < joints; ++i) {
    const std::string number = std::to_string(i);
    children.append(i > 1 ? "," : "").append(number);
    nodes.append(R"(,{"name":"j)").append(number).append("\"}");
  }
  nodes.insert(nodes.find('}'),
               std::string(R"(,"children":[)").append(children).append("]"));
  return R"({"asset":{"version":"2.0"},"nodes":[)" + nodes + R"(],
 "buffers":[{"byteLength":40,"uri":"keys.bin"}],
 "bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":32}],
 "accessors":[{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR"},
  {"bufferView":1,"componentType":5126,"count":2,"type":"VEC4"}],
 "animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"rotation"}}],
 "samplers":[{"input":0,"output":1}]}]})";
}

TEST(ReadCharacter, RefusesKeysThatStandForMoreFramesThanFitIntoMemory) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder, two_keys(folder, 20, 1.0F)), "no refusal");
  EXPECT_EQ(refusal(folder, two_keys(folder, 1000, 1000.0F)),
            "the animation's few keys stand for 30001 frames, which do not fit into "
            "memory");
  EXPECT_EQ(refusal(folder, two_keys(folder, 2, 1e6F)),
            "the animation has frames beyond the millionth");
}

TEST(ReadCharacter, RefusesNodesThatGoRoundInACircle) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder,
                    R"({"asset":{"version":"2.0"},
 "nodes":[{"name":"a","children":[1]},{"name":"b","children":[0]}]})"),
            "some nodes are their own ancestors");
}

TEST(ReadCharacter, RefusesAFileWithoutNodes) {
  const ScratchFolder folder;
  EXPECT_EQ(refusal(folder, R"({"asset":{"version":"2.0"}})"),
            "the joints have no common root");
}

TEST(ReadCharacter, SurvivesEveryCutOfAFile) {
  const ScratchFolder folder;
  const Proportions p = mannequin_proportions({});
  SkinnedMesh triangle = make_mannequin_mesh(p);
  triangle.parts.resize(1);
  triangle.parts[0].triangles.resize(3);
  ASSERT_TRUE(write_character(folder / "body.glb", make_humanoid(p), triangle));
  const std::string whole = *read_file(folder / "body.glb");
  // Only within the document: beyond it all cuts are equivalent.
  for (std::size_t size = 0; size < 4000; size += 37) {
    std::string cut = whole.substr(0, size);
    if (size >= 12) {  // The header agrees, so that the parser itself is reached.
      const auto announced = static_cast<std::uint32_t>(size);
      std::memcpy(cut.data() + 8, &announced, sizeof announced);
    }
    EXPECT_NE(refusal(folder, cut), "no refusal") << size;
  }
}

}  // namespace
}  // namespace marey::recordings
