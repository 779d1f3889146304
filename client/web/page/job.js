// One job: its progress, what it is, its picture and its files.
import { call, isGone, jobPath } from './api.js';
import { confirmed, showInteractive } from './dialogs.js';
import { Downloads } from './downloads.js';
import { announce, background, button, facts, h, numberField, setText, whenThemeChanges } from './elements.js';
import { showProgress } from './jobs.js';
import { count, counted, measure, moment, took } from './numbers.js';
import { History } from './history.js';
import { session } from './session.js';
import { activity, expiry, isActive, isRemoved, operatorOf, progress, repairNotes, wording } from './text.js';

// What of a job decides which facts, notes and buttons there are.
const kShown = ['state', 'prepared', 'quality', 'cancel_requested', 'pinned', 'expires_ms', 'removed_ms'];
const shown = (job) => job && JSON.stringify(kShown.map((name) => job[name]));
/** @type {(job: Job | undefined) => boolean} */
const hasResults = (job) => job?.state === 'done' && !isRemoved(job);

// What is up and what is in front, as the service takes it, and in words.
const kDirections = ['z', '-z', 'y', '-y', 'x', '-x'];
const axis = (direction) => direction.slice(-1);
const kStances = [
  ['shape', 'stands as its shape tells'],
  ...kDirections.flatMap((up) =>
    kDirections.filter((front) => axis(front) !== axis(up)).map((front) => [`${up},${front}`, `${up} up, facing ${front}`]),
  ),
];
const direction = (word) => word.replace('minus-', '-');
/** @type {(job: Job) => string} */
const stanceOf = ({ stance }) => (stance ? `${direction(stance.up)},${direction(stance.front)}` : 'shape');

/** @param {Job} job */
function asked(job) {
  const { sampling, directions, frame, minimum } = job.params;
  const lattice = sampling?.spacing ? `spacing ${measure(sampling.spacing)}` : `about ${counted(sampling?.target_points || 0, 'point')}`;
  return [
    ['Lattice asked for', lattice],
    ['Directions', directions || 'triangles'],
    ['Least over', wording('minima', minimum || session.usual.minimum)],
    ['Lattice along', wording('frames', frame || session.usual.frame)],
    ['Skeleton by', operatorOf(job)],
    ['Priority', String(job.priority || 0)],
    ['Owner', job.owner],
    ['Submitted', moment(job.created_ms)],
    ...(job.finished_ms > 0 && job.started_ms > 0 ? [['Took', took((job.finished_ms - job.started_ms) / 1000)]] : []),
    ['Job', job.id],
  ];
}

/** @param {Job} job */
function prepared({ prepared: p }) {
  if (!p) return [];
  return [
    ['Triangles', count(p.triangles)],
    ['Sample points', count(p.points)],
    ['Spacing', measure(p.spacing)],
    ['Volume', measure(p.volume)],
    ['Solids', count(p.solids)],
  ];
}

/**
 * The threshold of a sheet that is being turned; the files are made by the same.  Of points the page has a slider.
 * @param {Job} job
 * @param {import('./downloads.js').Downloads} downloads
 * @param {() => Promise<void>} show again
 */
function thresholdControls(job, downloads, show) {
  if (!session.sheets.includes(downloads.operator.value || job.skeleton.operator || session.usual.operator)) return [];
  const field = numberField('view-threshold', { placeholder: 'usual' });
  const told = h('span', { class: 'small', role: 'status' });
  field.value = downloads.threshold.value;
  field.addEventListener('change', async () => {
    downloads.threshold.value = field.value;
    const wrong = downloads.check();
    told.textContent = wrong || 'A moment …';
    if (wrong) return;
    try {
      await show();
      told.textContent = '';
    } catch (error) {
      told.textContent = error.message;
    }
  });
  return [told, h('label', { for: 'view-threshold' }, 'Threshold'), field];
}

/** What is seen at #job/ID. */
export class JobView {
  /**
   * @param {string} id
   * @param {import('./rate.js').Rates} rates
   */
  constructor(id, rates) {
    this.id = id;
    this.rates = rates;
    this.title = 'Job';
    this.heading = h('h1', { tabindex: -1 }, 'Job');
    this.badge = h('span', { class: 'badge' });
    this.bar = h('progress', { max: 1, hidden: true });
    this.numbers = h('p', { class: 'numbers' });
    this.what = h('p', { class: 'what' });
    this.notes = h('ul', { class: 'notes' });
    this.facts = h('div', {});
    this.actions = h('div', { class: 'row wrap actions' });
    this.results = h('div', { class: 'results' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.history = new History(id);
    this.about = h('section', { class: 'card' }, h('h2', {}, 'About this job'), this.facts, this.history.element);
    this.drawn = 0; // how often the picture was asked for
    this.element = h(
      'section',
      {},
      h('p', {}, h('a', { href: '#jobs' }, '← All jobs')),
      h('div', { class: 'row head' }, this.heading, this.badge),
      h('div', { class: 'card' }, this.bar, this.numbers, this.what, this.notes, this.actions, this.problem),
      this.results,
      this.about,
    );
  }

  refresh() {} // the page's poll puts itself here,
  pause() {} // and here

  /** @param {AbortSignal} signal */
  async ask(signal) {
    try {
      this.show(await call('GET', jobPath(this.id), undefined, signal));
    } catch (error) {
      if (isGone(error)) this.forget();
      throw error;
    }
    return isActive(this.job);
  }

  // It was deleted meanwhile: nothing of it can be had.
  forget() {
    const told = this.job ? 'It was deleted meanwhile, and nothing of it is left.' : 'There is no such job, or it is somebody else’s.';
    this.job = undefined;
    for (const part of [this.badge, this.bar, this.about]) part.hidden = true;
    for (const part of [this.numbers, this.actions, this.results, this.notes]) part.replaceChildren();
    setText(this.what, told);
  }

  show(job) {
    const before = this.job;
    this.job = job;
    this.title = job.name;
    document.title = `${job.name} – affskel`;
    setText(this.heading, job.name || 'Job');
    this.badge.className = `badge ${job.state}`;
    setText(this.badge, wording('states', job.state));
    showProgress(this.bar, job);
    setText(this.numbers, progress(job, this.rates.update(job)));
    setText(this.what, activity(job));
    this.what.classList.toggle('error', job.state === 'failed');
    if (before && before.state !== job.state) announce(`${job.name}: ${wording('states', job.state)}`);
    if (shown(before) !== shown(job)) {
      this.showFacts(job);
      this.showActions(job);
      this.history.refresh();
    }
    if (hasResults(job) && !hasResults(before)) this.showResults(job);
    if (!hasResults(job)) this.results.replaceChildren();
  }

  /** @param {Job} job */
  showFacts(job) {
    const removal = expiry(job);
    const warning = (message) => h('li', { class: 'warning' }, message);
    // The warnings of a done job are those of its mesh, too.
    const notes = [...repairNotes(job), ...(job.prepared?.notes || [])].filter((note) => !job.warnings || note.severity !== 'warning');
    this.notes.replaceChildren(
      ...notes.map((note) => h('li', { class: note.severity }, note.message)),
      ...(job.warnings || []).map((one) => warning(one.message)),
      ...(removal ? [warning(removal)] : []),
    );
    this.facts.replaceChildren(facts([...prepared(job), ...asked(job)]));
  }

  /** @param {Job} job */
  showActions(job) {
    const held = document.activeElement?.closest('.actions') ? document.activeElement.id : null;
    const ended = !isActive(job);
    this.actions.replaceChildren(
      ...[
        !ended && !job.cancel_requested && button('Cancel', () => this.cancel(), { id: 'cancel' }),
        (job.state === 'cancelled' || job.state === 'failed' || isRemoved(job)) && button('Resume', () => this.act('POST', '/resume'), { id: 'resume', class: 'primary' }),
        !job.pinned && job.expires_ms > 0 && button('Keep', () => this.act('POST', '/pin'), { id: 'pin' }),
        job.pinned && button('Keep no longer', () => this.act('POST', '/unpin'), { id: 'unpin' }),
        ended && h('a', { class: 'button', id: 'again', href: `#new/${job.id}` }, 'Again with other parameters'),
        ended && button('Delete', () => this.remove(), { id: 'delete', class: 'danger' }),
      ].filter(Boolean),
    );
    // The button that was pressed may be another now.
    if (held !== null) (this.actions.querySelector('button, a') || this.heading).focus();
  }

  async act(method, rest, body) {
    this.problem.hidden = true;
    try {
      await call(method, jobPath(this.id, rest), body);
      this.refresh();
    } catch (error) {
      this.complain(error);
    }
  }

  complain(error) {
    this.problem.textContent = error.message;
    this.problem.hidden = false;
  }

  async cancel() {
    const wanted = await confirmed(`Cancel ${this.job.name}?`, 'It stops within seconds. Its progress is kept, and it can be resumed.', 'Cancel the job');
    if (wanted) await this.act('POST', '/cancel');
  }

  async remove() {
    const wanted = await confirmed(`Delete ${this.job.name}?`, 'Its mesh, field and skeleton are removed for good.', 'Delete the job');
    if (!wanted) return;
    this.pause(); // a deleted job is not asked for
    try {
      await call('DELETE', jobPath(this.id));
      location.hash = '#jobs';
    } catch (error) {
      this.complain(error);
      this.refresh();
    }
  }

  /** @param {Job} job */
  showResults(job) {
    const downloads = new Downloads(this.job, () => this.drawPicture(downloads, picture, waiting));
    const picture = h('img', { class: 'picture', alt: `${job.name}: the body and its skeleton from the front, the side and above`, hidden: true });
    const waiting = h('p', { class: 'small', role: 'status' }, 'The picture is being drawn …');
    const stance = h(
      'select',
      { id: 'stance', 'aria-label': 'How it stands', title: 'How it stands in pictures' },
      kStances.map(([value, text]) => h('option', { value }, text)),
    );
    stance.value = stanceOf(job);
    stance.addEventListener('change', () => this.stand(stance, () => this.drawPicture(downloads, picture, waiting)));
    const beside = h('select', { id: 'beside', 'aria-label': 'Turn it beside another job' }, h('option', { value: '' }, 'Compare with …'));
    beside.addEventListener('focus', () => this.offerOthers(beside), { once: true });
    const interactive = button('Turn it', () => this.openInteractive(downloads, waiting, beside.value), { id: 'interactive', class: 'primary' });
    this.results.replaceChildren(
      h('section', { class: 'card' }, h('div', { class: 'row head' }, h('h2', {}, 'Skeleton'), stance, beside, interactive), waiting, picture),
      downloads.element,
    );
    this.drawPicture(downloads, picture, waiting);
    whenThemeChanges(picture, () => this.drawPicture(downloads, picture, waiting));
  }

  /**
   * Keeps with the job how it stands.
   * @param {HTMLSelectElement} stance
   * @param {() => void} draw
   */
  async stand(stance, draw) {
    await this.act('POST', '/stance', { stance: stance.value });
    if (this.problem.hidden) draw();
    else stance.value = stanceOf(this.job);
  }

  /**
   * @param {import('./downloads.js').Downloads} downloads
   * @param {HTMLImageElement} picture
   * @param {HTMLElement} waiting
   */
  async drawPicture(downloads, picture, waiting) {
    this.drawn += 1;
    const turn = this.drawn;
    waiting.textContent = 'The picture is being drawn …';
    try {
      const result = await downloads.made('picture', { background: background() });
      if (turn !== this.drawn) return; // other parameters by now
      picture.onload = () => {
        picture.hidden = false;
        waiting.textContent = [`Shown: ${result.shown}`, ...result.warnings.map((warning) => warning.message)].join('; ');
      };
      picture.src = result.href;
    } catch (error) {
      if (turn !== this.drawn) return;
      picture.hidden = true; // it would be of other parameters
      waiting.textContent = `There is no picture: ${error.message}`;
    }
  }

  /**
   * The jobs that this one can be compared with.
   * @param {HTMLSelectElement} beside
   */
  async offerOthers(beside) {
    const { jobs } = await call('GET', '/api/jobs?limit=200');
    for (const job of jobs) {
      if (job.id !== this.id && hasResults(job)) beside.append(h('option', { value: job.id }, `beside ${job.name}, ${moment(job.created_ms)}`));
    }
  }

  /**
   * @param {import('./downloads.js').Downloads} downloads
   * @param {HTMLElement} status
   * @param {string} beside another job, or ''
   */
  async openInteractive(downloads, status, beside) {
    const before = status.textContent;
    const made = () => downloads.made('view', beside ? { beside } : {});
    status.textContent = 'A moment …';
    try {
      const result = await made();
      status.textContent = before;
      const again = async () => show((await made()).href);
      const show = showInteractive(result.href, this.job.name, thresholdControls(this.job, downloads, again));
    } catch (error) {
      status.textContent = error.message;
    }
  }
}
