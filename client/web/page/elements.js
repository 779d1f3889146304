// Elements made by script, never from text with markup.

/**
 * An element with attributes (on... are listeners; false and null leave one out) and children.
 * @param {string} tag
 * @param {Object<string, any>} [attributes]
 * @param {...any} children
 * @returns {any}
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/**
 * A field for a number, as text: a browser's own number fields drop a comma, and tell nothing of what is no number.
 * @param {string} id
 * @param {Object<string, any>} [attributes]
 * @returns {HTMLInputElement}
 */
export const numberField = (id, attributes = {}) => h('input', { id, type: 'text', inputmode: 'decimal', autocomplete: 'off', ...attributes });

/**
 * Saves a file that the service has made.
 * @param {{ href: string, name: string }} result
 */
export function save(result) {
  const link = h('a', { href: result.href, download: result.name, hidden: true });
  document.body.append(link);
  link.click();
  link.remove();
}

/**
 * The element of the page with this id, which it has.
 * @param {string} id
 * @returns {any}
 */
export const byId = (id) => document.getElementById(id);

/**
 * The background of pictures that suits the page.
 * @returns {string}
 */
export const background = () => (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'white');

/**
 * Calls back whenever pictures are to have another background, as long as the element is on the page.
 * @param {Element} element
 * @param {() => void} draw
 */
export function whenThemeChanges(element, draw) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const changed = () => {
    if (element.isConnected) draw();
    else dark.removeEventListener('change', changed);
  };
  dark.addEventListener('change', changed);
}

/**
 * Sets the text only when it changes, so that screen readers hear no repetition.
 * @param {Element} element
 * @param {string} text
 */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Says something to screen readers that is seen anyway.
 * @param {string} text
 */
export function announce(text) {
  byId('announcement').textContent = text;
}

/**
 * A button that cannot be pressed twice while its action runs.
 * @param {string} label
 * @param {(element: HTMLElement) => any} action
 * @param {Object<string, any>} [attributes]
 * @returns {HTMLButtonElement}
 */
export function button(label, action, attributes = {}) {
  const element = h('button', { type: 'button', ...attributes }, label);
  element.addEventListener('click', async () => {
    if (element.getAttribute('aria-disabled') === 'true') return;
    element.setAttribute('aria-disabled', 'true');
    try {
      await action(element);
    } finally {
      element.removeAttribute('aria-disabled');
    }
  });
  return element;
}

/**
 * Pairs of a term and what it is.
 * @param {string[][]} pairs
 * @returns {HTMLElement}
 */
export function facts(pairs) {
  return h('dl', { class: 'facts' }, pairs.map(([term, value]) => h('div', {}, h('dt', {}, term), h('dd', {}, value))));
}
