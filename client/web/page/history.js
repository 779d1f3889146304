// What happened to a job: its events, asked for when they are looked at.
import { call, jobPath } from './api.js';
import { h } from './elements.js';
import { counted, moment } from './numbers.js';
import { eventText } from './text.js';

function line(event) {
  const what = [
    eventText(event.event),
    event.task > 0 && `task ${event.task}${event.kind ? ` (${event.kind})` : ''}`,
    event.worker && `worker ${event.worker.slice(0, 12)}`,
    event.message,
  ];
  const time = h('time', { datetime: new Date(event.time_ms).toISOString() }, moment(event.time_ms));
  return h('li', {}, time, ` ${what.filter(Boolean).join(', ')}`);
}

/** The events of one job. */
export class History {
  constructor(job) {
    this.job = job;
    this.list = h('ol', { class: 'history', tabindex: 0, 'aria-label': 'Events, oldest first' });
    this.problem = h('p', { class: 'error', role: 'alert', hidden: true });
    this.element = h('details', { id: 'history' }, h('summary', {}, 'What happened'), this.list, this.problem);
    this.element.addEventListener('toggle', () => this.refresh());
  }

  // Asks only while it is open.
  async refresh() {
    if (!this.element.open) return;
    try {
      const { events } = await call('GET', jobPath(this.job, '/events'));
      this.show(events);
      this.problem.hidden = true;
    } catch (error) {
      this.problem.textContent = error.message;
      this.problem.hidden = false;
    }
  }

  show(events) {
    const lines = [];
    let next = 1;
    for (const event of events) {
      if (event.number > next) lines.push(h('li', { class: 'small' }, `… ${counted(event.number - next, 'event')} left out`));
      lines.push(line(event));
      next = event.number + 1;
    }
    this.list.replaceChildren(...lines);
  }
}
