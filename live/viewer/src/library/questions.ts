// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Requests of the page of a library and their answers.

import type {PageWords} from '../protocol/protocol';
import type {LibraryQuestion, LibraryServerWords} from '../protocol/library_protocol';

/** marey keeps at most 16 unsent answers for a page. */
const MAX_OPEN = 8;

export type Reply =
  | {kind: 'answer'; words: LibraryServerWords}
  | {kind: 'refused'; text: string}
  | {kind: 'outdated'}
  | {kind: 'lost'};

interface Open {id: string; question: LibraryQuestion; done: (reply: Reply) => void}

export class Questions {
  /** Revision of the index that the page shows. */
  revision = 0;
  private readonly waiting: Open[] = [];
  private readonly open = new Map<string, Open>();
  private number = 0;

  /** `send` returns false if there is no connection. */
  constructor(private readonly send: (words: PageWords) => boolean) {}

  ask(question: LibraryQuestion): Promise<Reply> {
    return new Promise((done) => {
      this.waiting.push({id: String(++this.number), question, done});
      this.sendNext();
    });
  }

  /** Receives an answer. Returns false if it answers no request. */
  hear(words: LibraryServerWords | {type: 'error'; id?: string; text: string}): boolean {
    const id = 'id' in words ? words.id : undefined;
    const asked = id === undefined ? undefined : this.open.get(id);
    if (!asked) return false;
    this.open.delete(asked.id);
    if (words.type === 'error') asked.done({kind: 'refused', text: words.text});
    else if (words.type === 'outdated') asked.done({kind: 'outdated'});
    else asked.done({kind: 'answer', words});
    this.sendNext();
    return true;
  }

  /** The connection is lost, and with it the answers. */
  lose(): void {
    const lost = [...this.open.values(), ...this.waiting.splice(0)];
    this.open.clear();
    for (const {done} of lost) done({kind: 'lost'});
  }

  private sendNext(): void {
    while (this.open.size < MAX_OPEN) {
      const next = this.waiting.shift();
      if (!next) return;
      const {id, question} = next;
      if (this.send({...question, id, revision: this.revision})) this.open.set(id, next);
      else next.done({kind: 'lost'});
    }
  }
}
