// The list of jobs, live.
import { call, jobPath } from './api.js';
import { confirmed, showProblem } from './dialogs.js';
import { announce, background, button, h, save, setText, whenThemeChanges } from './elements.js';
import { ago, count, counted, measure } from './numbers.js';
import { session } from './session.js';
import { activity, isActive, isRemoved, progress, progressOf, wording } from './text.js';

const kMostJobs = 1000; // that the service lists

/** @type {Object<string, {text: string, compare: (a: Job, b: Job) => number}>} */
const kOrders = {
  newest: { text: 'newest first', compare: (a, b) => b.created_ms - a.created_ms },
  oldest: { text: 'oldest first', compare: (a, b) => a.created_ms - b.created_ms },
  name: { text: 'by name', compare: (a, b) => a.name.localeCompare(b.name) },
  points: { text: 'most points first', compare: (a, b) => (b.prepared?.points || 0) - (a.prepared?.points || 0) },
};

/**
 * What tells jobs of one mesh apart.
 * @param {Job} job
 */
function asked({ params, prepared, skeleton }) {
  const { sampling, directions, frame, minimum } = params;
  const points = prepared?.points || sampling?.target_points;
  const spacing = prepared?.spacing || sampling?.spacing;
  const unusual = (word, usual) => word && word !== usual && word;
  return [
    points && counted(points, 'point'),
    spacing && `spacing ${measure(spacing)}`,
    unusual(directions, 'triangles'),
    unusual(frame, session.usual.frame),
    unusual(minimum, session.usual.minimum),
    skeleton.operator || session.usual.operator,
    skeleton.threshold && `threshold ${measure(skeleton.threshold)}`,
  ].filter(Boolean).join(', ');
}

// The small pictures are asked for one after the other: the service draws few at once.
let drawing = Promise.resolve();
function showThumbnail(image, job) {
  const loaded = () =>
    new Promise((resolve) => {
      image.onload = () => resolve(image.removeAttribute('hidden'));
      image.onerror = resolve;
      image.src = `${jobPath(job.id, '/thumbnail')}?background=${background()}`;
    });
  drawing = drawing.then(() => image.isConnected && loaded());
}
const whenSeen = new IntersectionObserver((entries) => {
  for (const { isIntersecting, target } of entries) {
    if (!isIntersecting) continue;
    whenSeen.unobserve(target);
    target.dispatchEvent(new Event('seen'));
  }
});

// One job in the list.
class Card {
  /** @param {Job} job */
  constructor(job) {
    this.link = h('a', { href: `#job/${job.id}` });
    this.badge = h('span', {});
    this.bar = h('progress', { max: 1 });
    this.numbers = h('p', { class: 'numbers' });
    this.what = h('p', { class: 'what' });
    this.asked = h('span', {});
    this.age = h('span', {});
    this.chosen = h('input', { type: 'checkbox' });
    this.image = h('img', { class: 'thumbnail', alt: '', hidden: true });
    this.place = h('span', { class: 'place' }, this.image);
    this.element = h(
      'li',
      { class: 'card job', id: `job-${job.id}` },
      this.chosen,
      this.place,
      h(
        'div',
        { class: 'told' },
        h('h2', {}, this.link),
        this.badge,
        h('p', { class: 'small when' }, this.asked, this.age),
        this.bar,
        this.numbers,
        this.what,
      ),
    );
    this.state = job.state;
    this.job = job;
    this.watched = false; // whether its picture is asked for once it is seen
  }

  /**
   * @param {Job} job
   * @param {Rate | null} rate
   */
  update(job, rate) {
    this.job = job;
    this.chosen.setAttribute('aria-label', `Select ${job.name}`);
    setText(this.link, job.name || job.id.slice(0, 12));
    this.badge.className = `badge ${job.state}`;
    setText(this.badge, wording('states', job.state));
    showProgress(this.bar, job);
    setText(this.numbers, progress(job, rate));
    setText(this.what, activity(job));
    const owner = session.admin && job.owner !== session.owner ? `${job.owner}, ` : '';
    setText(this.asked, `${owner}${asked(job)}`);
    setText(this.age, `submitted ${ago(job.created_ms)}`);
    if (job.state === 'done' && !isRemoved(job) && !this.watched) {
      this.watched = true;
      whenSeen.observe(this.place);
      this.place.addEventListener('seen', () => showThumbnail(this.image, this.job), { once: true });
      whenThemeChanges(this.image, () => showThumbnail(this.image, this.job));
    }
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
  const { done, total } = progressOf(job);
  if (total > 0) bar.value = done / total;
  else if (job.state !== 'running') bar.value = 0; // where nothing goes on, nothing moves
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
    this.beyond = h('p', { class: 'small', hidden: true }, `These are the newest ${count(kMostJobs)} jobs; affskel-client list has older ones, too.`);
    this.search = h('input', { type: 'search', id: 'search', 'aria-label': 'Search in names, owners, ids and parameters', placeholder: 'Search' });
    this.state = h(
      'select',
      { id: 'state', 'aria-label': 'State' },
      h('option', { value: '' }, 'in any state'),
      Object.entries(session.words.states).map(([word, text]) => h('option', { value: word }, text)),
    );
    this.order = h(
      'select',
      { id: 'order', 'aria-label': 'Order' },
      Object.entries(kOrders).map(([word, { text }]) => h('option', { value: word }, text)),
    );
    this.owner = h('select', { id: 'owner', 'aria-label': 'Owner', hidden: true }, h('option', { value: '' }, 'of anybody'));
    this.search.addEventListener('input', () => this.arrange());
    for (const control of [this.state, this.owner, this.order]) control.addEventListener('change', () => this.arrange());
    this.selected = h('span', { class: 'small', role: 'status' });
    this.together = h(
      'div',
      { class: 'row wrap together', hidden: true },
      this.selected,
      button('Download them', () => this.downloadSelected(), { id: 'download-selected' }),
      button('Cancel them', () => this.cancelSelected(), { id: 'cancel-selected' }),
      button('Delete them', () => this.deleteSelected(), { id: 'delete-selected', class: 'danger' }),
    );
    this.list.addEventListener('change', () => this.showSelected());
    this.nothing = h('p', { class: 'card', hidden: true }, 'No job shown here is like that.');
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
      h('div', { class: 'row wrap filters' }, this.search, this.state, this.owner, this.order),
      this.together,
      this.none,
      this.nothing,
      this.list,
      this.more,
      this.beyond,
    );
    this.title = 'Jobs';
  }

  async showMore() {
    this.limit = Math.min(kMostJobs, 2 * this.limit);
    await this.refresh();
  }

  refresh() {} // the page's poll puts itself here

  /**
   * Whether something happens.
   * @param {AbortSignal} signal
   */
  async ask(signal) {
    const path = `/api/jobs?limit=${this.limit}${this.everybody ? '&everybody=1' : ''}`;
    const { jobs, more } = await call('GET', path, undefined, signal);
    const ids = new Set(jobs.map((job) => job.id));
    for (const [id, card] of this.cards) {
      if (ids.has(id)) continue;
      card.element.remove();
      this.cards.delete(id);
    }
    this.rates.keep(ids);
    for (const job of jobs) this.show(job);
    this.offerOwners(jobs);
    this.arrange();
    this.none.hidden = jobs.length > 0;
    this.more.hidden = !more || this.limit >= kMostJobs;
    this.beyond.hidden = !more || this.limit < kMostJobs;
    return jobs.some(isActive);
  }

  /** @param {Job} job */
  show(job) {
    let card = this.cards.get(job.id);
    if (!card) {
      card = new Card(job);
      this.cards.set(job.id, card);
    }
    card.update(job, this.rates.update(job));
  }

  // Of several owners' jobs those of one can be seen alone.
  offerOwners(jobs) {
    const owners = [...new Set([...jobs.map((job) => job.owner), this.owner.value])].filter(Boolean).sort();
    const offered = [...this.owner.options].slice(1).map((option) => option.value);
    if (owners.join('\n') !== offered.join('\n')) {
      const chosen = this.owner.value;
      this.owner.replaceChildren(h('option', { value: '' }, 'of anybody'), ...owners.map((owner) => h('option', { value: owner }, `of ${owner}`)));
      this.owner.value = chosen;
    }
    this.owner.hidden = owners.length < 2;
  }

  // Which cards are seen, and where.
  arrange() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    const seen = ({ job }) => {
      const told = asked(job);
      const text = `${job.name} ${job.owner} ${job.id} ${told} ${told.replaceAll(',', '')}`.toLowerCase();
      if (this.owner.value && job.owner !== this.owner.value) return false;
      return (!this.state.value || job.state === this.state.value) && words.every((word) => text.includes(word));
    };
    const cards = [...this.cards.values()].sort((a, b) => kOrders[this.order.value].compare(a.job, b.job));
    cards.forEach((card, place) => {
      card.element.hidden = !seen(card);
      if (card.element.hidden) card.chosen.checked = false;
      // Moved only where the order has changed: a moved element loses the focus.
      const there = this.list.children[place];
      if (there !== card.element) this.list.insertBefore(card.element, there || null);
    });
    this.nothing.hidden = cards.length === 0 || cards.some((card) => !card.element.hidden);
    this.showSelected();
  }

  chosen() {
    return [...this.cards.values()].filter((card) => card.chosen.checked).map((card) => card.job);
  }

  showSelected() {
    const jobs = this.chosen();
    this.together.hidden = jobs.length === 0;
    setText(this.selected, `${counted(jobs.length, 'job')} selected`);
  }

  // Fields, skeletons and meshes.
  async downloadSelected() {
    const jobs = this.chosen().filter((job) => job.state === 'done' && !isRemoved(job));
    showProblem(jobs.length === 0 ? 'None of the selected jobs has results.' : null);
    if (jobs.length === 0) return;
    setText(this.selected, `The archive of ${counted(jobs.length, 'job')} is being made …`);
    try {
      save(await call('POST', '/api/archives', { jobs: jobs.map((job) => job.id) }));
    } catch (error) {
      showProblem(error.message);
    }
    this.showSelected();
  }

  async cancelSelected() {
    const jobs = this.chosen().filter(isActive);
    if (jobs.length === 0) showProblem('None of the selected jobs is waiting or running.');
    const wanted = jobs.length > 0 && await confirmed(`Cancel ${counted(jobs.length, 'job')}?`, 'Their progress is kept, and they can be resumed.', 'Cancel them');
    if (wanted) await this.each(jobs, (job) => call('POST', jobPath(job.id, '/cancel')));
  }

  async deleteSelected() {
    const jobs = this.chosen().filter((job) => !isActive(job));
    if (jobs.length === 0) showProblem('Jobs that wait or run must be cancelled before they can be deleted.');
    const wanted = jobs.length > 0 && await confirmed(`Delete ${counted(jobs.length, 'job')}?`, 'Their meshes, fields and skeletons are removed for good.', 'Delete them');
    if (wanted) await this.each(jobs, (job) => call('DELETE', jobPath(job.id)));
  }

  // One after the other; what goes wrong with some is told of each.
  async each(jobs, act) {
    const wrong = [];
    for (const job of jobs) {
      try {
        await act(job);
        const card = this.cards.get(job.id);
        if (card) card.chosen.checked = false;
      } catch (error) {
        wrong.push(`${job.name}: ${error.message}`);
      }
    }
    showProblem(wrong.length ? wrong.join('; ') : null);
    this.refresh();
  }
}
