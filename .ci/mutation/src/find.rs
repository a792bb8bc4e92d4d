//! Finds every place of a file where a fault can be put.
//!
//! Faults are swapped operators, turned signs, turned or removed conditions, `min` for `max`, and removed
//! statements. Left alone are tests, what is behind a feature that is off, constants and `const fn` (a switch
//! cannot be asked there), types, patterns, macros, and the writing of texts (`Display`, `Debug`).

use std::ops::Range;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, UnOp};

use crate::compiled::is_left_out;
use crate::fault::{Fault, Form};

/// All faults of a file, or why it cannot be read.
pub fn faults(file: &str, text: &str) -> syn::Result<Vec<Fault>> {
    let tree = syn::parse_file(text)?;
    if is_left_out(&tree.attrs) {
        return Ok(Vec::new());
    }
    let mut finder = Finder { file, text, faults: Vec::new() };
    finder.visit_file(&tree);
    Ok(finder.faults)
}

struct Finder<'a> {
    file: &'a str,
    text: &'a str,
    faults: Vec<Fault>,
}

impl Finder<'_> {
    fn add(&mut self, place: &impl Spanned, form: Form, replacement: String, change: String) {
        let span = place.span();
        let start = span.start();
        self.faults.push(Fault {
            file: self.file.to_owned(),
            range: span.byte_range(),
            form,
            replacement,
            change,
            line: start.line,
            column: start.column + 1,
            source: self.text.lines().nth(start.line - 1).unwrap_or_default().trim().to_owned(),
        });
    }

    fn text(&self, range: Range<usize>) -> &str {
        &self.text[range]
    }

    /// The text of `whole` with the part at `range` written otherwise.
    fn with(&self, whole: &impl Spanned, range: Range<usize>, other: &str) -> String {
        let whole = whole.span().byte_range();
        format!("{}{other}{}", self.text(whole.start..range.start), self.text(range.end..whole.end))
    }

    fn operator(&mut self, whole: &Expr, operator: &BinOp) {
        let others: &[&str] = match operator {
            BinOp::Add(_) => &["-"],
            BinOp::Sub(_) => &["+"],
            BinOp::Mul(_) => &["/"],
            BinOp::Div(_) | BinOp::Rem(_) => &["*"],
            BinOp::And(_) => &["||"],
            BinOp::Or(_) => &["&&"],
            BinOp::BitAnd(_) | BinOp::BitXor(_) => &["|"],
            BinOp::BitOr(_) => &["&"],
            BinOp::Shl(_) => &[">>"],
            BinOp::Shr(_) => &["<<"],
            BinOp::Eq(_) => &["!="],
            BinOp::Ne(_) => &["=="],
            BinOp::Lt(_) => &["<=", ">"],
            BinOp::Le(_) => &["<", ">="],
            BinOp::Gt(_) => &[">=", "<"],
            BinOp::Ge(_) => &[">", "<="],
            BinOp::AddAssign(_) => &["-="],
            BinOp::SubAssign(_) => &["+="],
            BinOp::MulAssign(_) => &["/="],
            BinOp::DivAssign(_) => &["*="],
            BinOp::BitOrAssign(_) => &["&="],
            BinOp::BitAndAssign(_) => &["|="],
            _ => &[],
        };
        let range = operator.span().byte_range();
        let this = self.text(range.clone()).to_owned();
        for other in others {
            let replacement = self.with(whole, range.clone(), other);
            self.add(whole, Form::Expression, replacement, format!("{this} → {other}"));
        }
    }

    fn condition(&mut self, condition: &Expr, has_other_way: bool) {
        if has_let(condition) {
            return;
        }
        if has_other_way {
            let replacement = format!("!({})", self.text(condition.span().byte_range()));
            self.add(condition, Form::Expression, replacement, "condition turned round".to_owned());
        } else {
            self.add(condition, Form::Expression, "false".to_owned(), "condition → false".to_owned());
        }
    }
}

/// `let` can stand in a chain of `&&`, which then is no expression that can be put in brackets.
fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_left_out(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        if !is_left_out(&function.attrs) && function.sig.constness.is_none() {
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_left_out(&function.attrs) && function.sig.constness.is_none() {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_impl(&mut self, block: &'ast syn::ItemImpl) {
        let name = block.trait_.as_ref().and_then(|(_, path, _)| path.segments.last());
        let writes = name.is_some_and(|name| name.ident == "Display" || name.ident == "Debug");
        if !writes && !is_left_out(&block.attrs) {
            visit::visit_item_impl(self, block);
        }
    }

    fn visit_expr(&mut self, expression: &'ast Expr) {
        match expression {
            Expr::Binary(binary) if !has_let(expression) => self.operator(expression, &binary.op),
            Expr::Unary(unary) => {
                let sign = match unary.op {
                    UnOp::Neg(_) => "-",
                    UnOp::Not(_) => "!",
                    _ => "",
                };
                if !sign.is_empty() {
                    let operand = self.text(unary.expr.span().byte_range()).to_owned();
                    self.add(expression, Form::Expression, operand, format!("{sign} removed"));
                }
            }
            Expr::If(branch) => self.condition(&branch.cond, branch.else_branch.is_some()),
            Expr::MethodCall(call) => {
                let other = match call.method.to_string().as_str() {
                    "min" => "max",
                    "max" => "min",
                    _ => "",
                };
                if !other.is_empty() && call.args.len() == 1 {
                    let replacement = self.with(expression, call.method.span().byte_range(), other);
                    let change = format!("{} → {other}", call.method);
                    self.add(expression, Form::Expression, replacement, change);
                }
            }
            _ => {}
        }
        visit::visit_expr(self, expression);
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if let Some((_, guard)) = &arm.guard {
            self.condition(guard, false);
        }
        visit::visit_arm(self, arm);
    }

    fn visit_stmt(&mut self, statement: &'ast syn::Stmt) {
        if let syn::Stmt::Expr(expression, Some(_)) = statement {
            let removable =
                matches!(expression, Expr::Assign(_) | Expr::MethodCall(_) | Expr::Call(_) | Expr::Binary(_));
            if removable {
                self.add(statement, Form::Statement, String::new(), "statement removed".to_owned());
            }
        }
        visit::visit_stmt(self, statement);
    }

    // Where no switch can be asked.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_variant(&mut self, _: &'ast syn::Variant) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }
}
