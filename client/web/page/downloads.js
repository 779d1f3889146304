// The files of a finished job, and its pictures.
import { call, jobPath } from './api.js';
import { announce, button, h } from './elements.js';
import { bytes } from './numbers.js';
import { session } from './session.js';
import { kArtefacts } from './text.js';

// Saves what the service has made.
function save(result) {
  const link = h('a', { href: result.href, download: result.name, hidden: true });
  document.body.append(link);
  link.click();
  link.remove();
}

/** The card of files, with what they are made by. */
export class Downloads {
  constructor(job) {
    this.job = job;
    this.operator = h(
      'select',
      { id: 'download-operator' },
      h('option', { value: '' }, 'the job’s operator'),
      Object.entries(session.words.operators).map(([word, text]) => h('option', { value: word }, text)),
    );
    this.threshold = h('input', { id: 'download-threshold', type: 'number', min: 0, step: 'any', inputmode: 'decimal', placeholder: 'usual' });
    this.level = h('input', { id: 'download-level', type: 'number', min: 0, max: 100, step: 'any', inputmode: 'decimal', value: 10 });
    this.status = h('p', { class: 'small', role: 'status' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.element = h(
      'section',
      { class: 'card' },
      h('h2', {}, 'Download'),
      h('div', { class: 'downloads' }, session.artefacts.map((artefact) => this.row(artefact))),
      h(
        'details',
        {},
        h('summary', {}, 'Other parameters, without eroding again'),
        h(
          'div',
          { class: 'fields' },
          h('div', {}, h('label', { for: 'download-operator' }, 'Shocks found by'), this.operator),
          h('div', {}, h('label', { for: 'download-threshold' }, 'Threshold'), this.threshold),
          h('div', {}, h('label', { for: 'download-level' }, 'Erosion level, % of the volume'), this.level),
        ),
      ),
      this.status,
      this.problem,
    );
  }

  row(artefact) {
    const [title, what] = kArtefacts[artefact.name] || [artefact.name, ''];
    return h(
      'div',
      { class: 'artefact' },
      h('p', {}, h('strong', {}, title), ` ${what}`),
      h(
        'div',
        { class: 'row wrap', role: 'group', 'aria-label': `${title} as` },
        artefact.formats.map((format) =>
          button(format, () => this.fetch(artefact.name, format), {
            'aria-label': `${title} as ${format}`,
            'data-file': artefact.name + format,
          }),
        ),
      ),
    );
  }

  parameters() {
    const threshold = parseFloat(this.threshold.value);
    const level = parseFloat(this.level.value);
    return {
      operator: this.operator.value,
      threshold: threshold > 0 ? threshold : 0,
      fraction: level > 0 && level < 100 ? level / 100 : 0,
    };
  }

  async fetch(artefact, format) {
    this.problem.hidden = true;
    this.status.textContent = 'The file is being made …';
    try {
      const result = await call('POST', jobPath(this.job, '/results'), { artefact, format, ...this.parameters() });
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
  async made(artefact) {
    announce('A moment, it is being made.');
    const { operator, threshold } = this.parameters();
    return call('POST', jobPath(this.job, '/results'), { artefact, operator, threshold });
  }
}
