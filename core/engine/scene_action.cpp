// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/engine/scene_action.h"

namespace marey {
namespace {

const std::string kNoTarget;

struct TargetOf {
  const std::string& operator()(const ScenePlay& /*deed*/) const { return kNoTarget; }
  const std::string& operator()(const SceneStop& /*deed*/) const { return kNoTarget; }
  const std::string& operator()(const SceneCarry& /*deed*/) const { return kNoTarget; }
  const std::string& operator()(const SceneThrow& deed) const { return deed.aim; }
  template <class Deed>
  const std::string& operator()(const Deed& deed) const {
    return deed.target;
  }
};

struct IsEndless {
  bool operator()(const ScenePlay& deed) const { return deed.loops; }
  bool operator()(const SceneStop& /*deed*/) const { return false; }
  bool operator()(const SceneReach& deed) const { return deed.holds; }
  bool operator()(const SceneThrow& /*deed*/) const { return false; }
  bool operator()(const SceneSteer& deed) const { return deed.keeps; }
  bool operator()(const SceneJump& /*deed*/) const { return false; }
  bool operator()(const SceneFollow& /*deed*/) const { return true; }
  bool operator()(const SceneCarry& /*deed*/) const { return true; }
  bool operator()(const SceneConstrain& /*deed*/) const { return true; }
};

}  // namespace

const std::string& target_of(const SceneAction& action) {
  return std::visit(TargetOf{}, action.deed);
}

bool is_endless(const SceneAction& action) {
  return !action.for_s && std::visit(IsEndless{}, action.deed);
}

}  // namespace marey
