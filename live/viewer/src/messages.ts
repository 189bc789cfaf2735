// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// What there is to say, newest first: the server's messages for as long as it says them,
// the page's own, which nobody takes back, for as long as there is room.

const MOST_MESSAGES = 8;

export class Messages {
  private ofServer: readonly string[] = [];
  private ofPage: string[] = [];

  /** Newest last, as a status has them. */
  serve(messages: readonly string[]): void {
    this.ofServer = messages;
  }

  /** What was said last is not said again. */
  add(message: string): void {
    if (this.ofPage.includes(message)) return;
    this.ofPage = [message, ...this.ofPage].slice(0, MOST_MESSAGES);
  }

  shown(): string[] {
    return [...new Set([...this.ofPage, ...[...this.ofServer].reverse()])];
  }
}
