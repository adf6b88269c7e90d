// simple cubic lattice of like spheres, prescribed overlaps of three directions
#include <cstdio>
#include <random>
#include <vector>
#include <string>
#include "epdem/laws.hpp"
#include "epdem/contact.hpp"
using namespace epdem;
const double R=1.0, RS=0.5;
template<class Law> struct Lattice {
  Law law; BodyShares<double> bodies; double all[body_values]{}; double mem[memory_values]{}; double pressure=0;
  State<Law> st[3]{}; GrowthState<double> g[3]{}; double F[3]{}, U[3]{}, lost=0, adh=0, a[3]{}, Q=0; double old[3]; bool first=true;
  Lattice(const Law& l):law(l){ bodies=body_shares({1.0,0.3},{1.0,0.3},0.5);} 
  void step(const double* ov){
    BodySums<double> b{all[0],all[1],all[2],all[3]};
    double sums[dent_sums]{};
    for(int k=0;k<3;k++){
      Growing<false,double> c{R,R,1/R,1/R,b,b,g[k],{}};
      double closing=first?0:ov[k]-old[k];
      auto s=grown_step(law,bodies,RS,st[k],ov[k],closing,c,false);
      State<Law> before=st[k];
      if constexpr(adheres<Law>){ auto e=grown_energies(law,RS,before,s,ov[k],closing,true); lost+=e.plastic_work_step; adh+=e.adhesion_loss; U[k]=e.stored; }
      else { auto e=grown_energies(law,RS,before.point,s,ov[k],closing,true); lost+=e.plastic_work_step; U[k]=e.stored; }
      F[k]=s.step.force; a[k]=s.step.radius; st[k]=s.step.after; st[k].delta_max=s.delta_max; g[k]=c.state;
      add_dent(sums,c.dents.i); add_dent(sums,c.dents.j); old[k]=ov[k];
    }
    first=false;
    auto n=sums_of_step(sums,all[2+0]*0+pressure,mem); pressure=n.pressure; all[0]=n.growth; all[1]=n.area; all[2]=n.pressure; all[3]=n.parted; Q=1-n.parted;
  }
};
template<class Law> void run(const char* name,const Law& law,const std::vector<std::vector<double>>& marks,int n,bool print){
  Lattice<Law> L(law); double W=0, Fo[3]{}, o[3]; double ov[3]; for(int k=0;k<3;k++) o[k]=marks[0][k]; L.step(o); for(int k=0;k<3;k++) Fo[k]=L.F[k];
  double size=0, worst=0, W0=0;
  for(size_t m=1;m<marks.size();m++){ for(int i=1;i<=n;i++){ for(int k=0;k<3;k++) ov[k]=marks[m-1][k]+(marks[m][k]-marks[m-1][k])*i/n; L.step(ov); double dW=0; for(int k=0;k<3;k++){ bool jump=(L.F[k]==0)!=(Fo[k]==0); dW+=0.5*(L.F[k]+Fo[k])*(ov[k]-o[k]); o[k]=ov[k]; Fo[k]=L.F[k];} W+=dW; size+=fabs(dW);
     double err=W-(L.U[0]+L.U[1]+L.U[2])-L.lost-L.adh; if(fabs(err)>worst) worst=fabs(err);} 
   if(print) printf("%s mark %zu: F %.12g %.12g %.12g  W %.10g held %.10g lost %.10g adh %.6g err %.3g Q %.4f added %.4g gam %.3f\n",name,m,L.F[0],L.F[1],L.F[2],W,L.U[0]+L.U[1]+L.U[2],L.lost,L.adh,(W-(L.U[0]+L.U[1]+L.U[2])-L.lost-L.adh)/size,L.Q,L.g[0].added,L.g[0].screening);
  }
  printf("%s n=%d worst/size %.3g\n",name,n,worst/size);
}
int main(int argc,char**argv){
  double Y=argc>1?atof(argv[1]):0.01, share=argc>2?atof(argv[2]):0.5, cs=argc>3?atof(argv[3]):1e6; int n=argc>4?atoi(argv[4]):1000;
  double E=1.0; double lim=6.6*Y*Y*Y*RS/E/E; double p[]={share*lim,Y,1.6,2.8,cs};
  CavityAdhesive<double> A(E,p); double p0[]={0.0,Y,1.6,2.8,cs}; CavityAdhesive<double> A0(E,p0); Cavity<double> C(E,p+1);
  std::vector<std::vector<double>> marks={{-1e-4,-1e-4,-1e-4},{.05,.05,.05},{.12,.12,.12},{.115,.115,.115},{.12,.12,.12},{.10,.12,.12},{.12,.12,.12},{.08,.08,.08},{.15,.15,.15},{.0,.0,.0},{-.01,-.01,-.01}};
  run("cavity",C,marks,n,true); run("adh G=0",A0,marks,n,true); run("adh",A,marks,n,true);
  for(int q: {n/2,n,2*n,4*n}) { run("adh",A,marks,q,false); run("cavity",C,marks,q,false);} 
}
