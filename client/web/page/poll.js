// Asks again and again: soon while something happens, seldom while the page is hidden, less and less after errors.

const kSoon = 1000;
const kIdle = 5000;
const kHidden = 20000; // a private server leaves after a minute without calls
const kLongest = 30000;

/** One question, asked as long as its view is seen. */
export class Poll {
  // `ask` returns whether something happens; it throws when there is no answer, which `failed` is told.
  constructor(ask, failed) {
    this.ask = ask;
    this.failed = failed;
    this.failures = 0;
    this.timer = 0;
    this.round = 0;
    document.addEventListener('visibilitychange', () => {
      if (this.timer !== 0 && !document.hidden) this.now();
    });
  }

  // Asks at once, and from then on.
  async now() {
    const round = ++this.round;
    clearTimeout(this.timer);
    this.timer = -1;
    let busy = false;
    try {
      busy = await this.ask();
      if (this.failures > 0) this.failed(null);
      this.failures = 0;
    } catch (error) {
      if (round !== this.round) return;
      ++this.failures;
      this.failed(error);
    }
    if (round !== this.round) return; // stopped, or asked anew meanwhile
    const pause = this.failures > 0 ? Math.min(kLongest, kSoon * 2 ** this.failures) : busy ? kSoon : kIdle;
    this.timer = setTimeout(() => this.now(), document.hidden ? Math.max(pause, kHidden) : pause);
  }

  stop() {
    ++this.round;
    clearTimeout(this.timer);
    this.timer = 0;
  }
}
