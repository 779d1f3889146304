// How fast jobs get on, smoothed over a few seconds; a page knows no more than it saw.
import { progressOf } from './text.js';

const kForgets = 3; // seconds
const kLeastMeasured = 1; // seconds: what is done comes in lots, which tell no rate alone

/** By job. */
export class Rates {
  constructor() {
    this.jobs = new Map();
  }

  /**
   * What the job's progress is worth by now, directions or points per second; null while nothing is known.
   * @param {Job} job
   */
  update(job, now = performance.now() / 1000) {
    const last = this.jobs.get(job.id);
    const { done } = progressOf(job);
    if (last && done >= last.done && now - last.time < kLeastMeasured) return this.of(job);
    const entry = { time: now, done, perSecond: last ? last.perSecond : 0 };
    if (last && done >= last.done) {
      const seconds = now - last.time;
      const weight = last.perSecond > 0 ? 1 - Math.exp(-seconds / kForgets) : 1;
      entry.perSecond += weight * ((done - last.done) / seconds - entry.perSecond);
    } else if (last && done < last.done) {
      entry.perSecond = 0;
    }
    this.jobs.set(job.id, entry);
    return this.of(job);
  }

  /** @param {Job} job */
  of(job) {
    const entry = this.jobs.get(job.id);
    if (!entry || !(entry.perSecond > 1e-6)) return null;
    return { perSecond: entry.perSecond };
  }

  // Forgets all jobs but these.
  keep(ids) {
    for (const id of this.jobs.keys()) if (!ids.has(id)) this.jobs.delete(id);
  }
}
