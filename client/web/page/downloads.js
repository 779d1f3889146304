// The files of a finished job, and its pictures.
import { call, jobPath } from './api.js';
import { announce, button, h, numberField, save } from './elements.js';
import { bytes, typed } from './numbers.js';
import { session } from './session.js';
import { kArtefacts } from './text.js';

const kUsualLevel = 10; // of eroded solids, % of the volume

// A number of a field, 0 for an empty one; null for one that cannot be.
function numberIn(field, most) {
  if (field.value.trim() === '') return 0;
  const value = typed(field.value);
  return value > 0 && value < most ? value : null;
}

/** The card of files, with what they are made by; picture and interactive page are made by the same. */
export class Downloads {
  /**
   * @param {Job} job
   * @param {() => void} changed other parameters, all of which can be
   */
  constructor(job, changed) {
    this.job = job.id;
    const offered = session.artefacts.filter(({ name }) => name !== 'source' || job.repair);
    this.changed = changed;
    this.operator = h(
      'select',
      { id: 'download-operator' },
      h('option', { value: '' }, 'the job’s operator'),
      Object.entries(session.words.operators).map(([word, text]) => h('option', { value: word }, text)),
    );
    this.threshold = numberField('download-threshold', { placeholder: 'usual' });
    this.level = numberField('download-level', { placeholder: `${kUsualLevel} in files, none in pictures` });
    this.status = h('p', { class: 'small', role: 'status' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.wrong = h('p', { class: 'error', role: 'alert', hidden: true });
    for (const field of [this.operator, this.threshold, this.level]) field.addEventListener('change', () => this.check());
    this.element = h(
      'section',
      { class: 'card' },
      h('h2', {}, 'Download'),
      h('div', { class: 'downloads' }, offered.map((artefact) => this.row(artefact))),
      h(
        'details',
        {},
        h('summary', {}, 'Other parameters, without eroding again: of picture, turning view and files'),
        h(
          'div',
          { class: 'fields' },
          h('div', {}, h('label', { for: 'download-operator' }, 'Skeleton by'), this.operator),
          h('div', {}, h('label', { for: 'download-threshold' }, 'Threshold'), this.threshold),
          h('div', {}, h('label', { for: 'download-level' }, 'Erosion level, % of the volume'), this.level),
        ),
        this.wrong,
      ),
      this.status,
      this.problem,
    );
  }

  row(artefact) {
    const [title, what] = kArtefacts[artefact.name] || [artefact.name, ''];
    const row = h(
      'div',
      { class: 'artefact' },
      h('p', {}, h('strong', {}, title), ` ${what}`),
      h(
        'div',
        { class: 'row wrap', role: 'group', 'aria-label': `${title} as` },
        artefact.formats.map((format) =>
          button(format, () => this.fetch(artefact.name, format, row), {
            'aria-label': `${title} as ${format}`,
            'data-file': artefact.name + format,
          }),
        ),
      ),
    );
    return row;
  }

  // What the fields say.  Throws with what is wrong.
  parameters() {
    const threshold = numberIn(this.threshold, Infinity);
    if (threshold === null) throw new Error('The threshold must be a number above 0, or empty for the usual one.');
    const level = numberIn(this.level, 100);
    if (level === null) throw new Error('The erosion level must be above 0 and below 100 % of the volume.');
    return { operator: this.operator.value, threshold, fraction: level / 100 };
  }

  // Tells what is wrong beside the fields, and returns it; else what is shown is made anew.
  check() {
    let message = '';
    try {
      this.parameters();
    } catch (error) {
      message = error.message;
    }
    this.wrong.textContent = message;
    this.wrong.hidden = message === '';
    if (message === '') this.changed();
    return message;
  }

  // What is told of a file stands below its buttons.
  async fetch(artefact, format, row) {
    row.append(this.status, this.problem);
    this.problem.hidden = true;
    this.status.textContent = 'The file is being made …';
    try {
      const { fraction, ...skeleton } = this.parameters();
      const eroded = { fraction: fraction || kUsualLevel / 100 };
      const result = await call('POST', jobPath(this.job, '/results'), { artefact, format, ...skeleton, ...eroded });
      save(result);
      const notes = result.warnings.map((warning) => warning.message);
      this.status.textContent = `${result.name}, ${bytes(result.size)}${notes.length ? `. Note: ${notes.join('; ')}` : ''}`;
    } catch (error) {
      this.status.textContent = '';
      this.problem.textContent = error.message;
      this.problem.hidden = false;
    }
  }

  // An address of the picture or of the interactive page.
  async made(artefact, more = {}) {
    announce('A moment, it is being made.');
    return call('POST', jobPath(this.job, '/results'), { artefact, ...this.parameters(), ...more });
  }
}
