// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/motion.h"
#include "core/skeleton.h"

namespace marey::retarget {

/// Does the skeleton's rest pose show a body on its feet that faces +Z: trunk up, legs
/// down, its left side towards +X? Many BVH files do not care what their zero pose looks
/// like. Bones that are not marked are not asked. Precondition: hips and legs are marked.
[[nodiscard]] bool rests_standing(const Skeleton& skeleton);

/// The motion's skeleton, but resting as somebody who stands, facing +Z with flat feet: a
/// rest pose that map_body() can read. Bone lengths, names and joints' own axes are kept,
/// so that the motion's poses remain poses of it.
///
/// Each part of the body rests as in the frame in which it shows best how it is built,
/// turned about the vertical until the hips face +Z: the trunk where it is most upright
/// and shoulders are least turned against the hips, each leg where it is straight and
/// hangs, each arm where it is straight and hangs or points to its side, each foot where
/// its ankle and toe joint are lowest. The hips stand as high as those legs do on the
/// floor Y = 0 of the motion. Linear in frames times joints.
/// Precondition: hips and legs are marked; there is a pose.
[[nodiscard]] Skeleton standing_rest(const Motion& motion);

}  // namespace marey::retarget
