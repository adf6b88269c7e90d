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

template<class Law> void walk(const char* name,const Law& law,int n,int seed,double low){
  // press to .12, then 30 random places below the peak (each direction by itself), back to the peak of each: closed cycles
  Lattice<Law> L(law); std::mt19937 r(seed); std::uniform_real_distribution<double> u(low,0.1195);
  double p[3]={-1e-4,-1e-4,-1e-4}; double Fo[3],W=0,size=0; L.step(p); for(int k=0;k<3;k++) Fo[k]=L.F[k];
  auto go=[&](double x,double y,double z,int m){ double q[3]={x,y,z},b[3]={p[0],p[1],p[2]}; for(int i=1;i<=m;i++){ double o[3]={p[0],p[1],p[2]}; for(int k=0;k<3;k++) p[k]=b[k]+(q[k]-b[k])*i/m; L.step(p); double dW=0; for(int k=0;k<3;k++){ dW+=.5*(L.F[k]+Fo[k])*(p[k]-o[k]); Fo[k]=L.F[k]; } W+=dW; size+=fabs(dW);} };
  go(.12,.12,.12,4*n); go(.118,.118,.118,n); double worst=0, sum=0; double U0=L.U[0]+L.U[1]+L.U[2];
  for(int c=0;c<40;c++){ double W0=W; double l0=L.lost+L.adh; size=0; go(u(r),u(r),u(r),n); go(u(r),u(r),u(r),n); go(.118,.118,.118,n); double d=(W-W0)/size; if(d<worst) worst=d; sum+=W-W0; }
  printf("%s n=%d low=%g seed=%d: most negative work of a closed cycle / its work %.3g, net of 40 cycles / U %.3g\n",name,n,low,seed,worst,sum/U0);
}
int main(int argc,char**argv){
  for(double Y: {0.01,0.02}) for(double share:{0.3,0.9}) { double lim=6.6*Y*Y*Y*RS; double p[]={share*lim,Y,1.6,2.8,Y>.015?.82:1e6}; if(Y>.015) p[0]=share*largest_adhesion(CavityAdhesive<double>(1.0,p),RS); CavityAdhesive<double> A(1.0,p); Cavity<double> C(1.0,p+1);
   printf("Y %g share %g\n",Y,share);
   for(double low:{0.112,0.0}) for(int n:{1000,4000}) { walk("cavity",C,n,1,low); walk("adh",A,n,1,low);} }
}
