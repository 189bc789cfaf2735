// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Messages, newest first: the server's while they are in its status, and the page's own,
// which are never withdrawn, while there is room.

const MAX_MESSAGES = 8;

export class Messages {
  private ofServer: readonly string[] = [];
  private ofPage: string[] = [];

  /** Newest last, as in a status. */
  serve(messages: readonly string[]): void {
    this.ofServer = messages;
  }

  /** Ignores a repetition of the last message. */
  add(message: string): void {
    if (this.ofPage.includes(message)) return;
    this.ofPage = [message, ...this.ofPage].slice(0, MAX_MESSAGES);
  }

  shown(): string[] {
    return [...new Set([...this.ofPage, ...[...this.ofServer].reverse()])];
  }
}
