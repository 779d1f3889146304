// Questions, and the interactive page of a job.
import { byId, h } from './elements.js';

/**
 * Asks before something that cannot be taken back.  Resolves to whether it is wanted.
 * @param {string} question
 * @param {string} detail
 * @param {string} yes
 * @returns {Promise<boolean>}
 */
export function confirmed(question, detail, yes) {
  return new Promise((resolve) => {
    const dialog = h(
      'dialog',
      { 'aria-labelledby': 'question', 'aria-describedby': 'question-detail' },
      h('h2', { id: 'question' }, question),
      h('p', { id: 'question-detail' }, detail),
      h(
        'div',
        { class: 'row end' },
        h('button', { type: 'button', onclick: () => dialog.close('no'), autofocus: true }, 'Keep it'),
        h('button', { type: 'button', class: 'danger', onclick: () => dialog.close('yes') }, yes),
      ),
    );
    dialog.addEventListener('close', () => {
      dialog.remove();
      resolve(dialog.returnValue === 'yes');
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/**
 * Shows the interactive page over everything.  It runs in a sandbox of its own.
 * @param {string} href
 * @param {string} name
 * @param {HTMLElement[]} controls of what it shows
 * @returns {(href: string) => void} shows another page in its place, from where this one is seen
 */
export function showInteractive(href, name, controls) {
  const tab = h('a', { href, target: '_blank', rel: 'noopener' }, 'Open in a tab of its own');
  const frame = h('iframe', { src: href, sandbox: 'allow-scripts allow-downloads', allow: 'fullscreen *', title: `${name}: body and skeleton` });
  const dialog = h(
    'dialog',
    { class: 'full', 'aria-label': `${name}, to turn` },
    h(
      'div',
      { class: 'bar' },
      h('strong', {}, name),
      controls,
      tab,
      h('button', { type: 'button', id: 'close-interactive', onclick: () => dialog.close(), autofocus: true }, 'Close'),
    ),
    frame,
  );
  // Back closes it, and so does Escape within the page, which tells so: keys that it hears are not heard here.
  let seen = ''; // from where, as the page's own links keep it
  const hear = (event) => {
    if (event.source !== frame.contentWindow) return;
    if (event.data === 'affskel-escape') dialog.close();
    else if (typeof event.data?.affskelLink === 'string') seen = event.data.affskelLink;
  };
  const back = () => dialog.close();
  window.addEventListener('message', hear);
  window.addEventListener('popstate', back);
  history.pushState({ shown: 'interactive' }, '');
  dialog.addEventListener('close', () => {
    window.removeEventListener('message', hear);
    window.removeEventListener('popstate', back);
    if (history.state?.shown === 'interactive') history.back();
    dialog.remove();
  });
  document.body.append(dialog);
  dialog.showModal();
  return (next) => {
    tab.href = next;
    frame.contentWindow.location.replace(`${next}#${seen}`); // no step of Back of its own
  };
}

/**
 * A problem that is not about one field; null takes it away.
 * @param {string | null} message
 */
export function showProblem(message) {
  const place = byId('problem');
  if (place.textContent !== (message || '')) place.textContent = message || '';
  place.hidden = !message;
}
