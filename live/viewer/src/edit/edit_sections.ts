// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Sections of the edit page's tools in the scene.

import {Section} from '../panels/panels';
import type {ViewPanel} from '../panels/view_panel';
import type {Ghost} from '../edit_scene/ghost';
import type {JumpPanel} from '../edit_scene/jump_panel';
import type {LoopsPanel} from '../edit_scene/loops_panel';
import type {PathTool} from '../edit_scene/path_tool';
import type {PoseHandles} from '../edit_scene/pose_handles';

export interface SceneTools {
  handles: PoseHandles; path: PathTool; loops: LoopsPanel; jump: JumpPanel;
  ghost: Ghost;
}

/** Returns the sections in their order. The ghost is an option of the view. */
export function sceneSections({handles, path, loops, jump, ghost}: SceneTools,
  view: ViewPanel): Section[] {
  const body = new Section('joints', 'Drag the body', true);
  body.body.append(handles.element);
  const ways = new Section('path', 'Path', false);
  ways.body.append(path.element);
  view.section.body.append(ghost.element);
  return [body, ways, loops.section, jump.section, view.section];
}
