//! The execution table of the language's prose, acted out on sets of rays: what the renderer's walk must amount to.

use proptest::prelude::*;
use renderer::crex::compile;

use crate::scene::{Ray, Scene, Spawning, execute};
use crate::trees::{Forms, Tree, sequence, text};

/// Acts a crex out. `seen` are the rays that the scope sees; what is spawned goes there or, inside a group that holds, to
/// `held`, which joins `seen` when the outermost such group ends.
struct Stage<'s> {
    scene: &'s Scene,
    seen: Vec<Ray>,
    held: Vec<Ray>,
    holding: bool,
    needs: f32,
    /// Letter and rays of every run.
    rows: Vec<(char, usize)>,
    traced: Vec<Ray>,
}

impl Stage<'_> {
    fn sequence(&mut self, items: &[Tree]) {
        items.iter().for_each(|item| self.item(item));
    }

    fn item(&mut self, item: &Tree) {
        match item {
            Tree::Letter(component) => {
                let scene = self.scene;
                let needs = self.needs;
                let runs = |ray: &Ray| {
                    ray.steps.last().is_some_and(|last| last.0 == *component)
                        && scene.importance[ray.pixel as usize] >= needs
                };
                let (run, stay): (Vec<_>, Vec<_>) = std::mem::take(&mut self.seen).into_iter().partition(runs);
                self.seen = stay;
                self.rows.push((component.letter(), run.len()));
                for ray in run {
                    let children = renderer::component::Component::ALL.map(|component| scene.children(&ray, component));
                    let into = if self.holding { &mut self.held } else { &mut self.seen };
                    into.extend(children.into_iter().flatten());
                    self.traced.push(ray);
                }
            }
            Tree::Group('(', items) => self.sequence(items),
            Tree::Group('{', items) => {
                for (i, member) in items.iter().enumerate() {
                    self.needs = (i + 1) as f32 / (items.len() + 1) as f32;
                    self.item(member);
                }
                self.needs = 0.0;
            }
            Tree::Group(_, items) => {
                let outermost = !self.holding;
                self.holding = true;
                self.sequence(items);
                if outermost {
                    self.holding = false;
                    self.seen.append(&mut self.held);
                }
            }
            Tree::Times(k, item) => (0..*k).for_each(|_| self.item(item)),
            Tree::Star(item) => loop {
                let before = self.traced.len();
                self.item(item);
                if self.traced.len() == before {
                    break;
                }
            },
        }
    }
}

fn scenes() -> impl Strategy<Value = Scene> {
    let importance = prop::collection::vec((0..=8u8).prop_map(|i| f32::from(i) / 8.0), 1..6);
    (importance, any::<u64>(), 1..5usize)
        .prop_map(|(importance, seed, length)| Scene { importance, spawning: Spawning::Random { seed, length } })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_walk_does_what_the_prose_says(items in sequence(3, 3, Forms::ALL), scene in scenes()) {
        let crex = text(&items);
        let program = compile(&crex).map_err(|errors| TestCaseError::fail(format!("{crex}: {errors:?}")))?;
        let pixels = 0..scene.importance.len() as u32;

        let mut seen = Vec::new();
        for pixel in pixels.clone() {
            let primary = Ray { pixel, steps: Vec::new() };
            for component in renderer::component::Component::ALL {
                seen.extend(scene.children(&primary, component));
            }
        }
        let mut stage = Stage {
            scene: &scene, seen, held: Vec::new(), holding: false, needs: 0.0, rows: Vec::new(), traced: Vec::new(),
        };
        stage.sequence(&items);

        let execution = execute(&program, None, &scene, pixels.clone());
        let rows: Vec<_> =
            execution.rows.iter().map(|row| (row.stage.component.letter(), row.report.rays as usize)).collect();
        prop_assert_eq!(rows, stage.rows, "{}", crex);
        prop_assert_eq!(&execution.traced, &stage.traced, "{}", crex);
        let left: u64 = execution.left.iter().map(|(_, count)| count).sum();
        prop_assert_eq!(left as usize, stage.seen.len(), "{}", crex);

        let executed = renderer::schedule::executed(&program, &execution.rows);
        let short = compile(&executed.crex).map_err(|_| TestCaseError::fail(executed.crex.clone()))?;
        let again = execute(&short, Some(&executed.thresholds), &scene, pixels);
        prop_assert_eq!(again.traced, execution.traced, "{} for {}", executed.crex, crex);
    }

    /// The order inside `< >` changes no ray and no count.
    #[test]
    fn members_that_hold_may_run_in_any_order(
        (items, shuffled) in sequence(2, 4, Forms { brackets: false, ..Forms::ALL })
            .prop_flat_map(|items| (Just(items.clone()), Just(items).prop_shuffle())),
        scene in scenes(),
    ) {
        // Two members of one component share its rays: the first takes them. Only the sum is of the crex.
        let trace = |items: &[Tree]| {
            let crex = format!("<{}>", text(items));
            let program = compile(&crex).expect("a crex");
            execute(&program, None, &scene, 0..scene.importance.len() as u32)
        };
        let (one, other) = (trace(&items), trace(&shuffled));
        prop_assert_eq!(one.left, other.left);
        prop_assert_eq!(one.sorted(), other.sorted());
    }
}
