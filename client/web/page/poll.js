// Asks again and again: soon while something happens, seldom while the page is hidden, less and less after errors.

const kSoon = 1000;
const kIdle = 5000;
const kHidden = 20000; // a private server leaves after a minute without calls
const kLongest = 30000;

/**
 * Milliseconds until it is asked again what had no answer so often in a row.
 * @param {number} failures
 */
export const pauseAfter = (failures) => Math.min(kLongest, kSoon * 2 ** failures);

/** One question, asked as long as its view is seen. */
export class Poll {
  // `ask` gets the signal that ends its calls, and returns whether something happens; it throws when there is no
  // answer, which `failed` is told.
  constructor(ask, failed) {
    this.ask = ask;
    this.failed = failed;
    this.failures = 0;
    this.timer = 0;
    this.asking = new AbortController();
    document.addEventListener('visibilitychange', () => {
      if (this.timer !== 0 && !document.hidden) this.now();
    });
  }

  // Asks at once, and from then on.  An older question is given up: its answer may come after the newer one's, and
  // would show what was.
  async now() {
    this.stop();
    const asking = new AbortController();
    this.asking = asking;
    this.timer = -1;
    let busy = false;
    try {
      busy = await this.ask(asking.signal);
      if (this.failures > 0) this.failed(null);
      this.failures = 0;
    } catch (error) {
      if (asking.signal.aborted) return;
      ++this.failures;
      this.failed(error);
    }
    if (asking.signal.aborted) return; // stopped, or asked anew meanwhile
    const pause = this.failures > 0 ? pauseAfter(this.failures) : busy ? kSoon : kIdle;
    this.timer = setTimeout(() => this.now(), document.hidden ? Math.max(pause, kHidden) : pause);
  }

  stop() {
    this.asking.abort();
    clearTimeout(this.timer);
    this.timer = 0;
  }
}
