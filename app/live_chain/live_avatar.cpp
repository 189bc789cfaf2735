// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/live_chain/live_avatar.h"

#include <vector>

#include "app/motion/error_of_file.h"
#include "app/motion/motion_files.h"
#include "retarget/body/body_map.h"

namespace marey::app {

Result<retarget::LiveRetarget> make_live_retarget(const Skeleton& performer,
                                                  const OpenedAvatar& avatar) {
  retarget::LiveRetargetOptions options;
  options.soles = avatar.soles;
  options.skin = avatar.skin;
  options.hands->avatar_volume = avatar.volume;
  auto made = retarget::LiveRetarget::make(performer, avatar.skeleton, options);
  if (!made) return of_file(avatar.file, made.error());
  return made;
}

Result<live::VmcBody> make_vmc_body(const Skeleton& skeleton,
                                    const OpenedAvatar* avatar,
                                    live::VmcRest rest) {
  const auto map = retarget::map_body(skeleton);
  if (!map) return avatar ? of_file(avatar->file, map.error()) : map.error();
  const std::vector<glm::dquat> t_pose = t_pose_of(skeleton, *map);
  live::VmcBodyOptions options;
  options.rest = rest;
  options.t_pose_from_joint = t_pose;
  options.file_faces_back = avatar != nullptr && avatar->file_faces_back;
  auto body = live::VmcBody::make(skeleton, options);
  if (!body && avatar) return of_file(avatar->file, body.error());
  return body;
}

}  // namespace marey::app
