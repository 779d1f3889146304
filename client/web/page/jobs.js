// The list of jobs, live.
import { call } from './api.js';
import { announce, button, h, setText } from './elements.js';
import { ago } from './numbers.js';
import { session } from './session.js';
import { activity, isActive, progress, wording } from './text.js';

// One job in the list.
class Card {
  /** @param {Job} job */
  constructor(job) {
    this.link = h('a', { href: `#job/${job.id}` });
    this.badge = h('span', {});
    this.bar = h('progress', { max: 1 });
    this.numbers = h('p', { class: 'numbers' });
    this.what = h('p', { class: 'what' });
    this.when = h('p', { class: 'small' });
    this.element = h(
      'li',
      { class: 'card job', id: `job-${job.id}` },
      h('div', { class: 'row' }, h('h2', {}, this.link), this.badge),
      this.bar,
      this.numbers,
      this.what,
      this.when,
    );
    this.state = job.state;
  }

  /**
   * @param {Job} job
   * @param {Rate | null} rate
   */
  update(job, rate) {
    setText(this.link, job.name || job.id.slice(0, 12));
    this.badge.className = `badge ${job.state}`;
    setText(this.badge, wording('states', job.state));
    showProgress(this.bar, job);
    setText(this.numbers, progress(job, rate));
    setText(this.what, activity(job));
    const owner = session.admin && job.owner !== session.owner ? `${job.owner}, ` : '';
    setText(this.when, `${owner}submitted ${ago(job.created_ms)}`);
    if (job.state !== this.state) announce(`${job.name}: ${wording('states', job.state)}`);
    this.state = job.state;
  }
}

/**
 * The bar of a job; without a share while the mesh is checked.
 * @param {HTMLProgressElement} bar
 * @param {Job} job
 */
export function showProgress(bar, job) {
  bar.hidden = !isActive(job) && job.state !== 'cancelled';
  bar.setAttribute('aria-label', `Progress of ${job.name}`);
  if (job.directions_total > 0) bar.value = job.directions_done / job.directions_total;
  else if (job.state === 'queued') bar.value = 0;
  else bar.removeAttribute('value');
}

/** What is seen at #jobs. */
export class JobList {
  /** @param {import('./rate.js').Rates} rates */
  constructor(rates) {
    this.rates = rates;
    this.limit = 50;
    this.everybody = false;
    this.cards = new Map();
    this.list = h('ul', { class: 'jobs', 'aria-label': 'Jobs, newest first' });
    this.none = h(
      'div',
      { class: 'card empty', hidden: true },
      h('p', {}, 'There are no jobs yet.'),
      h('a', { class: 'button primary', href: '#new' }, 'Choose a mesh'),
    );
    this.more = button('Show older jobs', () => this.showMore(), { hidden: true });
    const all = h('input', { type: 'checkbox', id: 'everybody' });
    all.addEventListener('change', () => {
      this.everybody = all.checked;
      this.refresh();
    });
    this.element = h(
      'section',
      {},
      h(
        'div',
        { class: 'row head' },
        h('h1', { tabindex: -1 }, 'Jobs'),
        session.admin && h('label', { class: 'check', for: 'everybody' }, all, 'Everybody’s'),
        h('a', { class: 'button primary', href: '#new' }, 'New job'),
      ),
      this.none,
      this.list,
      this.more,
    );
    this.title = 'Jobs';
  }

  async showMore() {
    this.limit = Math.min(1000, 2 * this.limit);
    await this.refresh();
  }

  refresh() {} // the page's poll puts itself here

  // Whether something happens.
  async ask() {
    const { jobs, more } = await call('GET', `/api/jobs?limit=${this.limit}${this.everybody ? '&everybody=1' : ''}`);
    const ids = new Set(jobs.map((job) => job.id));
    for (const [id, card] of this.cards) {
      if (ids.has(id)) continue;
      card.element.remove();
      this.cards.delete(id);
    }
    this.rates.keep(ids);
    jobs.forEach((job, place) => this.show(job, place));
    this.none.hidden = jobs.length > 0;
    this.more.hidden = !more || this.limit >= 1000;
    return jobs.some(isActive);
  }

  /** @param {Job} job */
  show(job, place) {
    let card = this.cards.get(job.id);
    if (!card) {
      card = new Card(job);
      this.cards.set(job.id, card);
    }
    card.update(job, this.rates.update(job));
    // Moved only where the order has changed: a moved element loses the focus.
    const there = this.list.children[place];
    if (there !== card.element) this.list.insertBefore(card.element, there || null);
  }
}
