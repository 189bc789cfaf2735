# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# Folders inside the rooms, lowest first: a file may include its own folder and those
# before it. "." is the room's top folder. docs/architecture.md describes each folder;
# tests/folders.cmake checks the order.
set(core_LAYERS base signal . human edit library engine)
set(capture_LAYERS v4l2 sync video tags boards search feeds)
set(calib_LAYERS model bundle rig plan quality)
set(reconstruct_LAYERS
  clusters posture tags bundle labels markers motion segments subject tracks)
set(retarget_LAYERS
  base constraints bones body character contacts feet balance com hands motion
  adapt/algebra adapt/plan adapt/kernel adapt)
set(dynamics_LAYERS push flight momentum balance jumps)
set(edit_LAYERS signal state balance find filter splice jump ops markers .)
set(engine_LAYERS sync blend clips transition feet models detail actions sources step record .)
set(library_LAYERS clips features quality search duplicates segments labels export)
set(recordings_LAYERS
  base body edit takes motion gltf markers print session library moves scene)
set(live_LAYERS udp vmc page web)
set(app_LAYERS
  shell motion pages adapt convert print plan record check markers process retarget
  live_chain view edit jump library/sources library/find library/labels library/export
  library/build library/check library/page library engine live stage/run stage/figures
  stage/live stage inspect .)
