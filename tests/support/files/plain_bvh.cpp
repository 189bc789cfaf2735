// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files/plain_bvh.h"

#include <fstream>
#include <stdexcept>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

namespace marey::testing {

PlainBvh::PlainBvh(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string word;
  std::vector<int> open;
  bool is_end = false;
  std::size_t channel_count = 0;
  while (in >> word && word != "MOTION") {
    if (word == "ROOT" || word == "JOINT") {
      in >> word;
      names_.push_back(word);
      parents_.push_back(open.empty() ? -1 : open.back());
      offsets_.emplace_back(0.0);
      channels_.emplace_back();
      is_end = false;
    } else if (word == "End") {
      in >> word;
      is_end = true;
    } else if (word == "{") {
      open.push_back(is_end ? -1 : static_cast<int>(names_.size()) - 1);
    } else if (word == "}") {
      if (open.empty()) throw std::runtime_error(path.string() + ": braces");
      open.pop_back();
      is_end = false;
    } else if (word == "OFFSET") {
      glm::dvec3 v(0.0);
      in >> v.x >> v.y >> v.z;
      if (!is_end) offsets_.back() = v;
    } else if (word == "CHANNELS") {
      int count = 0;
      in >> count;
      for (int i = 0; i < count; ++i) {
        in >> word;
        channels_.back().push_back(
            {word.find("rotation") != std::string::npos, word[0] - 'X'});
        ++channel_count;
      }
    }
  }
  std::size_t frames = 0;
  in >> word >> frames >> word >> word >> frame_time_s_;
  frames_.assign(frames, std::vector<double>(channel_count, 0.0));
  for (auto& frame : frames_) {
    for (double& value : frame) in >> value;
  }
  if (!in || names_.empty()) throw std::runtime_error(path.string() + ": no BVH");
}

std::vector<glm::dvec3> PlainBvh::places(std::size_t frame) const {
  const std::vector<double>& values = frames_.at(frame);
  std::vector<glm::dmat4> world(names_.size(), glm::dmat4(1.0));
  std::vector<glm::dvec3> out;
  std::size_t at = 0;
  for (std::size_t j = 0; j < names_.size(); ++j) {
    glm::dvec3 place = offsets_[j];
    glm::dmat4 turn(1.0);
    bool moves = false;
    for (const Channel& channel : channels_[j]) {
      const double value = values[at++];
      if (channel.turns) {
        glm::dvec3 axis(0.0);
        axis[channel.axis] = 1.0;
        turn = glm::rotate(turn, glm::radians(value), axis);
      } else {
        if (!moves) place = glm::dvec3(0.0);
        moves = true;
        place[channel.axis] = value;
      }
    }
    const glm::dmat4 parent =
        parents_[j] < 0 ? glm::dmat4(1.0) : world[static_cast<std::size_t>(parents_[j])];
    world[j] = parent * glm::translate(glm::dmat4(1.0), place) * turn;
    out.emplace_back(world[j][3]);
  }
  return out;
}

}  // namespace marey::testing
