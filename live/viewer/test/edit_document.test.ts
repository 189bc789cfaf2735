// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// The page's copy of an edit: order of changes, previews, refusals.

import assert from 'node:assert/strict';
import {test} from 'node:test';
import {EditDocument} from '../src/edit/edit_document';
import {insertIndex, untilAfter} from '../src/edit/edit_view';
import type {EditPageWords, OpKeys, OpWords, PreviewWords, RevisionWords}
  from '../src/protocol/edit_protocol';

const op = (keys: OpKeys): OpWords => ({do: keys.do, off: false, text: '', keys});

function revision(number: number, ops: OpWords[] = []): RevisionWords {
  return {type: 'revision', revision: number, parent: number - 1, cause: 'edit', sha256: '',
    name: 'walk', recipe_file: 'walk.edit.toml', recipe_text: '', sources: [], avatars: [], ops,
    undo_possible: number > 1, redo_possible: false};
}

function preview(id: string): PreviewWords {
  return {type: 'preview', id, revision: 1, scene: 1, until: null, outputs: [], reports: [],
    findings: [], skeletons: null};
}

/** A document whose requests are collected. */
function make(): {edit: EditDocument; sent: EditPageWords[]; refused: string[];
  previews: PreviewWords[]; connection: {open: boolean}} {
  const sent: EditPageWords[] = [];
  const refused: string[] = [];
  const previews: PreviewWords[] = [];
  const connection = {open: true};
  const edit = new EditDocument((words) => {
    if (connection.open) sent.push(words);
    return connection.open;
  }, {onRevision() {}, onProgress() {}, onRendered() {}, onPreview: (one) => previews.push(one),
    onRefused: (text) => refused.push(text)});
  edit.hear(revision(1));
  return {edit, sent, refused, previews, connection};
}

const settle = (): Promise<void> => new Promise((done) => { setTimeout(done, 0); });

test('a second change waits for the first, and is computed from its result', async () => {
  const {edit, sent} = make();
  const first = edit.change(() => [{insert: 0, op: {do: 'plant@1'}}]);
  const second = edit.change((ops) => [{insert: ops.length, op: {do: 'mirror@1'}}]);
  await settle();
  assert.equal(sent.length, 1);
  assert.equal(sent[0].base_revision, 1);
  edit.hear({type: 'accepted', id: sent[0].id, revision: 2});
  await settle();
  assert.equal(sent.length, 1, 'the operations of revision 2 are not known yet');
  edit.hear(revision(2, [op({do: 'plant@1'})]));
  await settle();
  assert.deepEqual(sent[1], {type: 'edit', base_revision: 2, id: sent[1].id,
    ops_patch: [{insert: 1, op: {do: 'mirror@1'}}]});
  edit.hear(revision(3));
  edit.hear({type: 'accepted', id: sent[1].id, revision: 3});
  assert.deepEqual(await Promise.all([first, second]), [true, true]);
});

test('a stale or refused change is reported, and later ones go on', async () => {
  const {edit, sent, refused} = make();
  const stale = edit.change(() => [{remove: 0}]);
  const bad = edit.change(() => [{remove: 7}]);
  await settle();
  edit.hear(revision(2));
  edit.hear({type: 'stale', id: sent[0].id, about: 'edit', base_revision: 1, revision: 2});
  assert.equal(await stale, false);
  await settle();
  assert.equal(sent[1].base_revision, 2);
  edit.hear({type: 'error', id: sent[1].id, about: 'edit', text: 'there is no operation 8'});
  assert.equal(await bad, false);
  assert.equal(refused.length, 2);
  assert.match(refused[1], /no operation 8/);
});

test('a change that has become meaningless is not sent', async () => {
  const {edit, sent} = make();
  assert.equal(await edit.change(() => null), false);
  assert.equal(await edit.change(() => []), false);
  assert.equal(sent.length, 0);
});

test('of previews during an answer only the newest is sent', async () => {
  const {edit, sent, previews} = make();
  for (let i = 0; i < 5; ++i) edit.preview(() => [{insert: 0, op: {do: 'place@1', heading_deg: i}}]);
  await settle();
  for (let i = 5; i < 9; ++i) edit.preview(() => [{insert: 0, op: {do: 'place@1', heading_deg: i}}]);
  await settle();
  assert.equal(sent.length, 1);
  edit.hear(preview(sent[0].id));
  await settle();
  assert.equal(sent.length, 2);
  assert.deepEqual((sent[1] as {ops_patch: unknown}).ops_patch,
    [{insert: 0, op: {do: 'place@1', heading_deg: 8}}]);
  edit.hear(preview(sent[1].id));
  await settle();
  assert.equal(previews.length, 2);
});

test('a dropped preview is not sent, and an empty one renders the recipe', async () => {
  const {edit, sent} = make();
  edit.show({until: 2});
  await settle();
  assert.deepEqual(sent[0], {type: 'render', base_revision: 1, id: sent[0].id, until: 2});
  edit.preview(() => [{remove: 0}]);
  edit.dropPreview();
  edit.hear(preview(sent[0].id));
  await settle();
  assert.equal(sent.length, 1);
});

test('without a connection a change is refused with a next step, and later ones work', async () => {
  const {edit, sent, refused, connection} = make();
  const open = edit.change(() => [{remove: 0}]);
  await settle();
  edit.lose();
  assert.equal(await open, false);
  connection.open = false;
  assert.equal(await edit.undo(), false, 'nothing to undo in revision 1');
  assert.equal(await edit.change(() => [{remove: 0}]), false);
  assert.equal(refused.length, 2);
  assert.match(refused[0], /whether the last change was made/);
  assert.match(refused[1], /still running/);
  connection.open = true;
  const later = edit.change(() => [{remove: 0}]);
  await settle();
  edit.hear({type: 'accepted', id: sent[1].id, revision: 2});
  edit.hear(revision(2));
  assert.equal(await later, true);
});

test('a new operation receives the shown motion; a last retarget stays last', () => {
  const ops = [op({do: 'cut@1'}), op({do: 'retarget@1', avatar: 'a.glb'})];
  assert.equal(insertIndex([], null), 0);
  assert.equal(insertIndex(ops, null), 1);
  assert.equal(insertIndex(ops, 1), 1);
  assert.equal(insertIndex(ops, 0), 0);
});

test('the shown number of operations follows a change', () => {
  assert.equal(untilAfter([{insert: 2, op: {do: 'plant@1'}}], 2), 3);
  assert.equal(untilAfter([{insert: 3, op: {do: 'plant@1'}}], 2), 2);
  assert.equal(untilAfter([{remove: 1}, {remove: 1}], 2), 1);
  assert.equal(untilAfter([{move: 0, to: 2}], 2), 1);
  assert.equal(untilAfter([{move: 3, to: 0}], 2), 3);
  assert.equal(untilAfter([{toggle: 0, off: true}], 2), 2);
});
