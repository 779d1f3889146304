// The server, for administrators: workers, queue, throughput and disk.
import { call } from './api.js';
import { facts, h } from './elements.js';
import { ago, bytes, count, counted, moment } from './numbers.js';
import { isActive } from './text.js';

const kWatched = 200; // running jobs whose progress is added up

function workerRow(worker) {
  const doing = worker.silent ? 'silent: dead, stopped or cut off' : worker.task || 'idle';
  return h(
    'tr',
    { class: worker.silent ? 'silent' : null },
    h('th', { scope: 'row' }, worker.host || worker.id.slice(0, 12)),
    h('td', {}, count(worker.threads || 0)),
    h('td', {}, worker.memory > 0 ? bytes(worker.memory) : 'not told'),
    h('td', {}, doing),
    h('td', {}, ago(worker.last_seen_ms)),
  );
}

/** What is seen at #server. */
export class Overview {
  /** @param {import('./rate.js').Rates} rates */
  constructor(rates) {
    this.rates = rates;
    this.title = 'Server';
    this.facts = h('div', {});
    this.workers = h('tbody', {});
    this.element = h(
      'section',
      {},
      h('h1', { tabindex: -1 }, 'Server'),
      h('div', { class: 'card' }, this.facts),
      h(
        'div',
        { class: 'card scroll', tabindex: 0, role: 'region', 'aria-label': 'Workers' },
        h('h2', {}, 'Workers'),
        h(
          'table',
          {},
          h('thead', {}, h('tr', {}, ['Host', 'Threads', 'Memory', 'Works on', 'Heard from'].map((name) => h('th', { scope: 'col' }, name)))),
          this.workers,
        ),
      ),
    );
  }

  /**
   * Directions per second of all running jobs that are seen.
   * @param {Job[]} jobs
   */
  throughput(jobs) {
    let sum = 0;
    for (const job of jobs.filter(isActive)) sum += this.rates.update(job)?.perSecond || 0;
    this.rates.keep(new Set(jobs.map((job) => job.id)));
    return sum;
  }

  /** @param {AbortSignal} signal */
  async ask(signal) {
    const get = (path) => call('GET', path, undefined, signal);
    const [info, { jobs }] = await Promise.all([get('/api/server'), get(`/api/jobs?everybody=1&limit=${kWatched}`)]);
    const workers = info.workers || [];
    const awake = workers.filter((worker) => !worker.silent);
    this.facts.replaceChildren(
      facts([
        ['Waiting', counted(info.jobs_queued || 0, 'job')],
        ['Running', counted(info.jobs_running || 0, 'job')],
        ['All', counted(info.jobs_total || 0, 'job')],
        ['Throughput', `${count(this.throughput(jobs))} directions per second`],
        ['Workers', counted(awake.length, 'worker')],
        ['Database', bytes(info.database_bytes || 0)],
        ...(info.disk_free_bytes === undefined ? [] : [['Free on its disk', bytes(info.disk_free_bytes)]]),
        ['Running since', moment(info.started_ms)],
        ['Version', info.version],
      ]),
    );
    this.workers.replaceChildren(...workers.map(workerRow));
    if (workers.length === 0) this.workers.append(h('tr', {}, h('td', { colspan: 5 }, 'no worker has called in the last minute')));
    return jobs.some(isActive);
  }
}
