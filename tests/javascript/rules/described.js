// A rule of eslint: a module begins with a comment, and what it exports has JSDoc before it, with a type for every
// parameter of a function.
'use strict';

const functionOf = (declaration) => {
  if (declaration.type === 'FunctionDeclaration') return declaration;
  const [made] = declaration.declarations || [];
  return made && made.init && made.init.type === 'ArrowFunctionExpression' ? made.init : null;
};

module.exports = {
  create(context) {
    const source = context.getSourceCode();
    return {
      Program(node) {
        const [first] = source.getAllComments();
        if (!first || first.range[0] !== 0) context.report({ node, message: 'No comment says what the module is for.' });
      },
      ExportNamedDeclaration(node) {
        if (!node.declaration) return;
        const last = source.getCommentsBefore(node).pop();
        if (!last || last.type !== 'Block' || !last.value.startsWith('*') || last.loc.end.line + 1 !== node.loc.start.line) {
          context.report({ node, message: 'What is exported has no JSDoc.' });
          return;
        }
        const called = functionOf(node.declaration);
        const named = (last.value.match(/@param \{/g) || []).length;
        const typed = /@type \{/.test(last.value);
        if (called && !typed && named !== called.params.length) {
          context.report({ node, message: `${called.params.length} parameters, of which JSDoc types ${named}.` });
        }
      },
    };
  },
};
