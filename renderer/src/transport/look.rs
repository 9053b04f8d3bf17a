//! What a ray sees in a surface: an illum or a mirror may be something else to it, or nothing; patterns and textures
//! change what there is (Radiance reference manual).

use glam::DVec3;

use crate::color::Rgb;
use crate::geometry::{Hit, Ray};
use crate::material::{Alternate, DressId, EmitterKind, Interaction, Material, MistId};
use crate::pattern::{Finish, Memory, Place};
use crate::scene::{Light, Scene, Worn};

/// What a ray sees in a surface.
#[derive(Clone, Copy)]
pub(super) enum Look<'a> {
    /// The surface is not there.
    Through,
    /// Nothing comes from it.
    Black,
    /// The boundary of mist.
    Mist(MistId),
    /// A material as it is.
    Plain(&'a Material),
    /// The material that was made, as patterns and textures have it, and what they add to the unit normal of the surface's front.
    Dressed(DVec3),
}

/// Room for a material that patterns and textures make: a large thing, which few hits need.
pub(super) type Made = Option<Material>;

impl<'a> Look<'a> {
    /// The material, if there is one.
    pub(super) fn material<'b>(&self, made: &'b Made) -> Option<&'b Material>
    where
        'a: 'b,
    {
        match self {
            Self::Plain(material) => Some(material),
            Self::Dressed(_) => made.as_ref(),
            Self::Through | Self::Black | Self::Mist(_) => None,
        }
    }
}

/// Who looks.
#[derive(Clone, Copy)]
pub(super) struct Looker<'a> {
    pub(super) scene: &'a Scene,
    /// The ray, whose origin and direction count.
    pub(super) ray: Ray,
    /// Whether the ray descends from a diffuse or glossy event.
    pub(super) blind: bool,
    /// Chooses among the materials of mixtures.
    pub(super) u: f64,
}

impl<'a> Looker<'a> {
    pub(super) fn look(mut self, hit: &Hit, memory: &mut Memory, made: &mut Made) -> Look<'a> {
        let scene = self.scene;
        let Some(mut material) = scene.material(hit.surface) else { return Look::Through };
        if scene.is_cut_away(hit, self.ray.dir) {
            return Look::Through;
        }
        let front = hit.is_front(self.ray.dir);
        let mut worn = None;
        loop {
            let alternate = match material {
                Material::Dressed(id) => {
                    let worn = worn.get_or_insert_with(Worn::default);
                    let place = self.place(hit);
                    match scene.undress(*id, &mut self.u, &place, memory, worn) {
                        Some(base) => material = base,
                        None => return Look::Through,
                    }
                    continue;
                }
                Material::Mist(id) => return Look::Mist(*id),
                Material::Antimatter(id) => match scene.cut(*id, hit, self.ray.dir) {
                    Some(face) => {
                        material = face;
                        continue;
                    }
                    None => return Look::Through,
                },
                Material::Emitter(emitter) => match emitter.kind() {
                    // To rays that have counted its light already, the front of an illum is a light.
                    EmitterKind::Illum(_) if front && self.blind => return Look::Black,
                    EmitterKind::Illum(alternate) => alternate,
                    _ => break,
                },
                Material::Mirror(mirror) => {
                    let alternate = mirror.alternate();
                    let transparent = match alternate {
                        Alternate::None => false,
                        Alternate::Void => true,
                        Alternate::Material(id) => scene.is_transparent(id),
                    };
                    let replaced = !front || !self.blind || transparent;
                    if alternate == Alternate::None || !replaced {
                        break;
                    }
                    alternate
                }
                _ => break,
            };
            match alternate {
                Alternate::None | Alternate::Void => return Look::Through,
                // An alternate is defined before what names it, so this comes to an end.
                Alternate::Material(id) => material = &scene.materials[id.index()],
            }
            worn = None;
        }
        let grouped = scene.grouped(hit);
        let mut finish = match worn {
            None if grouped.is_none() && !matches!(material, Material::Programmed(_)) => {
                return Look::Plain(material);
            }
            None => Finish::default(),
            Some(worn) => scene.finish(&worn, &self.place(hit), memory),
        };
        if let Some(grouped) = grouped {
            finish.bend += grouped.bend;
        }
        match material {
            Material::Programmed(id) => {
                *made = scene.programmed(*id, &self.place(hit), finish.tint, finish.bend, memory);
                if made.is_some() { Look::Dressed(finish.bend) } else { Look::Black }
            }
            material => {
                *made = Some(material.tinted(finish.tint));
                Look::Dressed(finish.bend)
            }
        }
    }

    fn place(&self, hit: &Hit) -> Place<'a> {
        place(self.scene, hit, &self.ray)
    }
}

/// A hit as functions see it.
pub(super) fn place<'a>(scene: &'a Scene, hit: &Hit, ray: &Ray) -> Place<'a> {
    let grouped = scene.grouped(hit);
    let (uv, object) = grouped.map_or((None, None), |grouped| (grouped.uv, grouped.object));
    Place { point: hit.point, dir: ray.dir, normal: hit.normal, distance: hit.t, uv, object }
}

/// A ray that meets a distant source, as functions see it.
pub(super) fn far_away<'a>(ray: &Ray) -> Place<'a> {
    let point = ray.at(FAR);
    Place { point, dir: ray.dir, normal: -ray.dir, distance: FAR, uv: None, object: None }
}

/// How far Radiance takes distant sources to be.
const FAR: f64 = 1e10;

/// The fraction of `light` that a surface lets through without bending the ray; 0 if it stops it.
pub(super) fn passed<'a>(
    scene: &'a Scene,
    light: &Light,
    mut material: &'a Material,
    hit: &Hit,
    ray: &Ray,
    memory: &mut Memory,
) -> Rgb {
    if scene.is_cut_away(hit, ray.dir) {
        return Rgb::ONE;
    }
    loop {
        return match material {
            Material::Trans(_) | Material::Glass(_) => straight_through(material, hit, ray),
            Material::Mist(_) => Rgb::ONE,
            Material::Emitter(emitter) => {
                let EmitterKind::Illum(alternate) = emitter.kind() else { return Rgb::ZERO };
                // An illum already holds the light of the illums and glows behind it.
                let held = matches!(light.emitter().kind(), EmitterKind::Illum(_) | EmitterKind::Glow { .. });
                if held && hit.is_front(ray.dir) {
                    return Rgb::ZERO;
                }
                match alternate {
                    Alternate::None | Alternate::Void => Rgb::ONE,
                    // An alternate is defined before what names it, so this comes to an end.
                    Alternate::Material(id) => {
                        material = &scene.materials[id.index()];
                        continue;
                    }
                }
            }
            Material::Antimatter(id) => match scene.cut(*id, hit, ray.dir) {
                Some(face) => {
                    material = face;
                    continue;
                }
                None => Rgb::ONE,
            },
            Material::Dressed(id) => passed_dressed(scene, light, *id, hit, ray, memory),
            Material::Programmed(id) => {
                match scene.programmed(*id, &place(scene, hit, ray), Rgb::ONE, DVec3::ZERO, memory) {
                    Some(Material::Functional(functional, _)) => functional.passed,
                    Some(Material::Wgmd(wgmd)) => wgmd.shadow(),
                    _ => Rgb::ZERO,
                }
            }
            _ => Rgb::ZERO,
        };
    }
}

/// What a sheet or pane lets through.
fn straight_through(material: &Material, hit: &Hit, ray: &Ray) -> Rgb {
    let interaction = Interaction::new(ray.dir, hit.normal);
    match material {
        Material::Trans(trans) => trans.shadow(&interaction),
        Material::Glass(glass) => glass.shadow(&interaction),
        _ => Rgb::ZERO,
    }
}

fn passed_dressed(scene: &Scene, light: &Light, id: DressId, hit: &Hit, ray: &Ray, memory: &mut Memory) -> Rgb {
    let place = place(scene, hit, ray);
    let mut sum = Rgb::ZERO;
    for (part, material) in scene.shown(id, &place, memory) {
        if part > 0.0 {
            let passes = match material {
                None => Rgb::ONE,
                Some(material @ (Material::Trans(_) | Material::Glass(_))) => {
                    let tinted = material.tinted(scene.tint(id, &place, memory));
                    straight_through(&tinted, hit, ray)
                }
                Some(material) => passed(scene, light, material, hit, ray, memory),
            };
            sum += passes * part;
        }
    }
    sum
}
