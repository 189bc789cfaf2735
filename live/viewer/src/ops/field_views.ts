// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Form fields of single values: numbers, choices, instants, rotations, parts of the body.

import {button, checkbox, el} from '../base/elements';
import {boneWords} from '../base/words';
import {FieldFrame, newId, NumberEntry, TextEntry, VectorEntry} from './field_parts';
import type {FieldHost, FieldView} from './field_parts';
import {MAX_FRAME, recipeKeys, ROTATION_DEG} from './op_fields';
import type {ChoiceField, Field, NumberField, TextField, VectorField} from './op_fields';
import {BONES, GROUPS} from './op_schema';
import {instantChanges, instantOf, quaternionOf, rotationOf, rounded} from './op_values';
import type {Instant, InstantKind, Keys, Problems} from './op_values';

/** Returns the text of an empty input: what the absence of the key means. */
function emptyText(field: Field): string {
  if (field.required) return '';
  return field.default !== undefined ? String(field.default)
    : field.absent === 'none' ? '' : field.absent;
}

export function numberField(field: NumberField, host: FieldHost): FieldView {
  const id = newId();
  let problem = '';
  const entry: NumberEntry = new NumberEntry(field, {id, step: field.step,
    placeholder: emptyText(field)}, (value, isDone) => host.set({[field.key]: value}, isDone),
  () => frame.tell(entry.problem));
  const unit = field.unit === 'factor' ? '×' : field.unit === 'degrees' ? '°' : field.unit;
  const frame = new FieldFrame(field, id, entry.input, el('span', {class: 'unit'}, unit));
  entry.input.setAttribute('aria-describedby', frame.errorId);
  return {element: frame.element, show(keys, problems, prefix, isForced) {
    entry.show(keys[field.key] as number | undefined, isForced);
    problem = problems.get(prefix + field.key) ?? '';
    frame.tell(entry.problem || problem);
  }};
}

export function textField(field: TextField, host: FieldHost): FieldView {
  const id = newId();
  const list = newId();
  // A text is an annotation or a name: an unfinished one is not worth a preview.
  const entry: TextEntry = new TextEntry({id, placeholder: emptyText(field),
    list: field.suggest ? list : null}, (value, isDone) => {
    if (isDone) host.set({[field.key]: value ?? (field.required ? '' : undefined)}, true);
    else frame.tell('');
  }, () => frame.tell(entry.problem));
  const frame = new FieldFrame(field, id, entry.input, field.suggest
    ? el('datalist', {id: list}, ...BONES.map((bone) => el('option', {value: bone}))) : '');
  entry.input.setAttribute('aria-describedby', frame.errorId);
  return {element: frame.element, show(keys, problems, prefix, isForced) {
    entry.show(keys[field.key] as string | undefined, isForced);
    frame.tell(entry.problem || (problems.get(prefix + field.key) ?? ''));
  }};
}

export function booleanField(field: Field, host: FieldHost): FieldView {
  const label = checkbox(field.label, field.default === true,
    (on) => host.set({[field.key]: on}, true), {title: field.help});
  const box = label.querySelector('input')!;
  const element = el('div', {class: 'field field-wide', 'data-key': field.key}, label);
  return {element, show(keys) {
    box.checked = (keys[field.key] ?? field.default ?? false) === true;
  }};
}

function choiceName(field: ChoiceField, value: string): string {
  if (value === '') return field.absent;
  const name = field.supply ? value
    : BONES.includes(value) ? boneWords(value) : value.replaceAll('_', ' ');
  return String(field.default) === value ? `${name} (default)` : name;
}

export function choiceField(field: ChoiceField, host: FieldHost): FieldView {
  const id = newId();
  const select = el('select', {id, onchange: () => {
    const value = field.choices.find((one) => String(one) === select.value) ?? select.value;
    host.set({[field.key]: value === '' ? undefined : value}, true);
  }});
  const frame = new FieldFrame(field, id, select);
  select.setAttribute('aria-describedby', frame.errorId);
  let shown = '';
  return {element: frame.element, show(keys, problems, prefix) {
    const value = String(keys[field.key] ?? field.default ?? '');
    const choices = (field.supply ? host.shown()[field.supply] : field.choices).map(String);
    if (!choices.includes(value)) choices.unshift(value);
    if (!choices.includes('') && !field.required && field.default === undefined) {
      choices.unshift('');
    }
    if (shown !== choices.join('\n')) {
      shown = choices.join('\n');
      select.replaceChildren(...choices.map((one) =>
        el('option', {value: one}, choiceName(field, one))));
    }
    select.value = value;
    frame.tell(problems.get(prefix + field.key) ?? '');
  }};
}

export function vectorField(field: VectorField, host: FieldHost): FieldView {
  const entry: VectorEntry = new VectorEntry(field.axes, field.unit, field.label, 0.01, field,
    (value, isDone) => host.set({[field.key]: value}, isDone), () => frame.tell(entry.problem));
  const frame = new FieldFrame(field, null, entry.element);
  entry.describe(frame.errorId);
  return {element: frame.element, show(keys, problems, prefix, isForced) {
    entry.show(keys[field.key] as number[] | undefined, isForced);
    frame.tell(entry.problem || (problems.get(prefix + field.key) ?? ''));
  }};
}

export function groupsField(field: Field, host: FieldHost): FieldView {
  const boxes = GROUPS.map((group) => checkbox(group.replace('_', ' '), false, () => {
    const chosen = GROUPS.filter((_, i) => boxes[i].querySelector('input')!.checked);
    host.set({[field.key]: chosen.length > 0 ? chosen : undefined}, true);
  }));
  const hint = el('span', {class: 'hint'}, field.absent);
  const frame = new FieldFrame(field, null, ...boxes, hint);
  frame.element.classList.add('field-boxes');
  return {element: frame.element, show(keys, problems, prefix) {
    const chosen = Array.isArray(keys[field.key]) ? keys[field.key] as string[] : [];
    GROUPS.forEach((group, i) => {
      boxes[i].querySelector('input')!.checked = chosen.includes(group);
    });
    hint.hidden = chosen.length > 0;
    frame.tell(problems.get(prefix + field.key) ?? '');
  }};
}

/** Seconds, a frame, or an annotation. */
class InstantView implements FieldView {
  readonly element: HTMLElement;
  private readonly id = newId();
  private readonly frame: FieldFrame;
  private readonly kind: HTMLSelectElement;
  private readonly seconds: NumberEntry;
  private readonly frames: NumberEntry;
  private readonly note: TextEntry;
  private instant: Instant | null = null;
  private lastKind: InstantKind = 's';

  constructor(private readonly field: Field, private readonly host: FieldHost) {
    const number = (kind: InstantKind, max: number, step: number): NumberEntry =>
      new NumberEntry({min: 0, max}, {step, 'aria-label': `${field.label}, ${kind}`},
        (value, isDone) => this.setTo(value === undefined ? null : {kind, value}, isDone),
        () => this.tell());
    this.seconds = number('s', 1e6, 0.01);
    this.frames = number('frame', MAX_FRAME, 1);
    this.note = new TextEntry({list: host.namesId, 'aria-label': `${field.label}, annotation`,
      placeholder: 'left.strike[2]'}, (value, isDone) => {
      // Half a name would be an unknown annotation.
      if (isDone || host.shown().names.includes(value ?? '')) {
        this.setTo({kind: 'note', value: value ?? ''}, isDone);
      }
    }, () => this.tell());
    this.kind = el('select', {id: this.id, class: 'instant-kind',
      onchange: () => this.setKind(this.kind.value as InstantKind | '')},
    field.required ? null : el('option', {value: ''}, field.absent),
    el('option', {value: 's'}, 's'), el('option', {value: 'frame'}, 'frame'),
    el('option', {value: 'note'}, 'annotation'));
    const now = button({class: 'now', title: 'Take the shown instant', onclick: () =>
      this.setTo(this.now(this.instant?.kind === 'frame' ? 'frame' : 's'), true)}, 'now');
    this.frame = new FieldFrame(field, this.id, this.seconds.input, this.frames.input,
      this.note.input, this.kind, now);
    for (const {input} of [this.seconds, this.frames, this.note]) {
      input.setAttribute('aria-describedby', this.frame.errorId);
    }
    this.element = this.frame.element;
  }

  show(keys: Keys, problems: Problems, prefix: string, isForced: boolean): void {
    this.instant = instantOf(keys, this.field.key);
    this.lastKind = this.instant?.kind ?? this.lastKind;
    const kind = this.instant?.kind ?? (this.field.required ? this.lastKind : '');
    const value = this.instant?.value;
    this.kind.value = kind;
    this.element.dataset.instant = kind;
    // An emptied input of an optional instant stays open while it is typed in.
    for (const [entry, own] of [[this.seconds, 's'], [this.frames, 'frame'],
      [this.note, 'note']] as const) {
      entry.input.hidden = own !== kind && document.activeElement !== entry.input;
    }
    this.seconds.show(kind === 's' ? value as number | undefined : undefined, isForced);
    this.frames.show(kind === 'frame' ? value as number : undefined, isForced);
    this.note.show(kind === 'note' ? value as string : undefined, isForced);
    this.tell(problems.get(prefix + this.field.key));
  }

  private tell(problem = ''): void {
    this.frame.tell(this.seconds.problem || this.frames.problem || this.note.problem || problem);
  }

  private now(kind: 's' | 'frame'): Instant {
    const {now_s, rate_hz} = this.host.shown();
    return {kind, value: kind === 's' ? now_s : Math.round(now_s * rate_hz)};
  }

  private setTo(instant: Instant | null, isDone: boolean): void {
    this.host.set(instantChanges(this.field.key, instant), isDone);
  }

  /** Converts the value to another kind. */
  private setKind(kind: InstantKind | ''): void {
    const {names, rate_hz} = this.host.shown();
    const was = this.instant;
    if (kind === '') this.setTo(null, true);
    else if (kind === 'note') this.setTo({kind, value: names[0] ?? ''}, true);
    else if (kind === 's' && was?.kind === 'frame') {
      this.setTo({kind, value: rounded(Number(was.value) / rate_hz, 3)}, true);
    } else if (kind === 'frame' && was?.kind === 's') {
      this.setTo({kind, value: Math.round(Number(was.value) * rate_hz)}, true);
    } else this.setTo(this.now(kind), true);
    (kind === 'note' ? this.note : kind === 'frame' ? this.frames : this.seconds).input.focus();
  }
}

export function instantField(field: Field, host: FieldHost): FieldView {
  return new InstantView(field, host);
}

/** Axis times angle, or a quaternion. */
export function rotationField(field: Field, host: FieldHost): FieldView {
  const [deg, wxyz] = recipeKeys(field);
  let keys: Keys = {};
  const told = (): void => frame.tell(vector.problem || quaternion.problem);
  const vector = new VectorEntry([...'xyz'], '°', field.label, 1, ROTATION_DEG,
    (value, isDone) => host.set({[deg]: value, [wxyz]: undefined}, isDone), told);
  const quaternion = new VectorEntry([...'wxyz'], '', field.label, 0.01,
    {min: -1.001, max: 1.001},
    (value, isDone) => host.set({[deg]: undefined, [wxyz]: value}, isDone), told);
  const kind = el('select', {'aria-label': `${field.label}: form`, onchange: () => {
    if (kind.value === 'wxyz') {
      host.set({[deg]: undefined, [wxyz]: quaternionOf(keys[deg] as number[] ?? [0, 0, 0])}, true);
    } else if (kind.value === 'deg') {
      host.set({[deg]: rotationOf(keys[wxyz] as number[] ?? [1, 0, 0, 0]), [wxyz]: undefined},
        true);
    } else host.set({[deg]: undefined, [wxyz]: undefined}, true);
  }}, field.required ? null : el('option', {value: ''}, field.absent),
  el('option', {value: 'deg'}, 'axis × angle'), el('option', {value: 'wxyz'}, 'quaternion'));
  const frame = new FieldFrame(field, null, kind, vector.element, quaternion.element);
  vector.describe(frame.errorId);
  quaternion.describe(frame.errorId);
  return {element: frame.element, show(now, problems, prefix, isForced) {
    keys = now;
    kind.value = wxyz in keys ? 'wxyz' : deg in keys || field.required ? 'deg' : '';
    vector.element.hidden = kind.value !== 'deg';
    quaternion.element.hidden = kind.value !== 'wxyz';
    vector.show(keys[deg] as number[] | undefined, isForced);
    quaternion.show(keys[wxyz] as number[] | undefined, isForced);
    frame.tell(vector.problem || quaternion.problem || (problems.get(prefix + field.key) ?? ''));
  }};
}
