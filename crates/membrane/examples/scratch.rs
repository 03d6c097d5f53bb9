use signorini_membrane::{domain::*, field::*, problem::*, ils::*, equilibrium::*, plane_zone::*, line_zone::*, zone::Zone, quadrature::Cell};
use signorini_fem::Grid; use signorini_geometry::*; use std::sync::Arc;
struct P; impl signorini_solve::Progress for P { fn iteration(&mut self, i:&signorini_solve::Iteration){ println!("   {} res {:.3e} {} {:?}", i.iteration, i.residual, i.action, i.figures);} }
fn main(){
  let a: Vec<String> = std::env::args().collect();
  let n: usize = a[2].parse().unwrap(); let p: usize = a[3].parse().unwrap(); let f: f64 = a[4].parse().unwrap();
  let t0=std::time::Instant::now();
  if a[1]=="axi" {
    let b=Aabb::new(Point::<1>::new(0.0),Point::<1>::new(1.0)); let grid=Grid::<1>::new(b,[n],p);
    let m=Membrane{ domain: DomainOnGrid::new(Arc::new(BoxDomain(b)),&grid), grid, measure: Measure::Axisymmetric, tension: Arc::new(Constant(1.0)), load: Arc::new(Constant(-f)), floor: Some(Arc::new(Constant(-0.1))), supports: vec![None, Some(Support{index:0,displacement:Arc::new(Constant(0.0))})], support_count:1};
    let mut e=Elements::new(&m); let s=solve::<1,LineZone>(&m,&mut e,Start::Free,(0,0.0),&mut P);
    println!("{:?} it {} {:?} err {:e}", s.reason, s.iterations, s.zone.intervals, s.zone.intervals[0][1]-0.502474357083085); return;
  }
  let half = if a[1].starts_with("sq") {1.0} else {1.03};
  let b=Aabb::new(Point::<2>::new(-half,-half),Point::<2>::new(half,half)); let grid=Grid::<2>::new(b,[n,n],p);
  let dom: Arc<dyn Domain<2>> = if a[1].starts_with("sq") {Arc::new(BoxDomain(b))} else {Arc::new(ImplicitDomain(Ellipse{center:Point::zeros(),semi_axes:[1.0,1.0]}))};
  let np = dom.pieces();
  let floor: SharedField<2> = if a[1].ends_with("flat") {Arc::new(Constant(-0.1))} else { Arc::new(Formula(|[x,y]:[Jet<2>;2]| { let c=|v:Jet<2>| {let w=v*Jet::constant(std::f64::consts::TAU); w.chain(w.value.cos(),-w.value.sin(),-w.value.cos())}; -(Jet::constant(0.015)+Jet::constant(0.005)*c(x)*c(y)) })) };
  let m=Membrane{ domain: DomainOnGrid::new(dom,&grid), grid, measure: Measure::Plain, tension: Arc::new(Constant(1.0)), load: Arc::new(Constant(-f)), floor: Some(floor), supports: vec![Some(Support{index:0,displacement:Arc::new(Constant(0.0))});np], support_count:1};
  let mut e=Elements::new(&m); let s=solve::<2,PlaneZone>(&m,&mut e,Start::Free,(0,0.0),&mut P);
  let eq=s.equilibrium.as_ref().unwrap();
  let mut area=0.0; eq.for_each_point(|_,r,_,w| if signorini_membrane::zone::contact_index(r).is_some(){area+=w});
  let _ = Cell::<2>::Outside;
  println!("{:?} it {} counts {:?} area {:.12} unknowns {} unseen {:.2e} t {:?}", s.reason, s.iterations, s.zone.counts(), area, s.unknowns, s.unseen, t0.elapsed());
  for c in s.zone.curves(){ println!("  curve area {:.10} len {:.6} knots {}", c.signed_area(), c.length(), c.knots()); }
  if a[1]=="discflat" { let (mut lo,mut hi)=(9.0f64,0.0f64); for x in s.zone.curves()[0].samples(){ lo=lo.min(x.norm());hi=hi.max(x.norm());} println!("r err area {:e}  lo {:e} hi {:e}", (area/std::f64::consts::PI).sqrt()-0.502474357083085, lo-0.502474357083085, hi-0.502474357083085); }
  println!("{:?}", s.conditions.map(|c|(c.least_gap,c.least_gap_outside,c.least_pressure)));
}
